/// The log for programs: one JSON object a line (docs/results.md).
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace meniscus::app {

/// Appends lines to a file, each with one write: a reader or a kill meets
/// whole lines. Not for several threads at once.
class JsonLog {
 public:
  /// Throws IoError when the file cannot be opened. A last line that a kill
  /// cut short is ended first.
  explicit JsonLog(std::string path);
  ~JsonLog();
  JsonLog(const JsonLog&) = delete;
  JsonLog& operator=(const JsonLog&) = delete;

  /// {"time": UTC, then the `fields`}. False when the file takes no more; why
  /// is then in problem().
  bool write(const nlohmann::ordered_json& fields);
  const std::string& problem() const { return problem_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::string problem_;
  int file_ = -1;
};

}  // namespace meniscus::app
