/// The surfaces that a load or support names.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace meniscus::loads {

/// Surfaces that act as one: a name, or a list of them, each once.
struct Surfaces : std::vector<std::string> {
  using std::vector<std::string>::vector;
  Surfaces(std::string one)  // NOLINT: a name is a list of one
      : std::vector<std::string>{std::move(one)} {}
  Surfaces(const char* one)  // NOLINT: the same
      : std::vector<std::string>{one} {}
  /// "lug_1", "lug_1 and lug_2", for messages.
  std::string text() const;
};

}  // namespace meniscus::loads
