/// Environment variables of one test.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace meniscus {

/// The variable has this value, or none, until the end of the scope; then what
/// it had before.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, std::optional<std::string> value)
      : name_(name) {
    if (const char* before = std::getenv(name); before != nullptr) {
      before_ = before;
    }
    set(value);
  }
  ~EnvironmentVariable() { set(before_); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  void set(const std::optional<std::string>& value) const {
    if (value) {
      ::setenv(name_, value->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }

  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace meniscus
