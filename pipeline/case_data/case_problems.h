/// What the reader and the checks of a case find, gathered to be told at once.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case_entries.h"

namespace meniscus::case_data {

class CaseProblems {
 public:
  /// `path` and `overrides` as in Case, for the place of each message.
  CaseProblems(std::string path, std::vector<std::string> overrides)
      : path_(std::move(path)), overrides_(std::move(overrides)) {}

  void add(SourceLine line, const std::string& message);
  /// A message that names its place itself; once, however often it is added.
  void add_text(const std::string& message);
  void warn(SourceLine line, const std::string& message);
  /// "there is no material 'x'; did you mean 'y'?"
  void unknown(SourceLine line, const char* what, const std::string& name,
               const std::vector<std::string>& known);

  bool empty() const { return problems_.empty(); }
  std::size_t size() const { return problems_.size(); }

  /// In the order of lines, overrides first; at most 20, then how many more.
  std::vector<std::string> take();
  std::vector<std::string> take_warnings();

 private:
  struct Entry {
    SourceLine line;
    std::string text;
  };
  std::string with_location(SourceLine line, const std::string& message) const;

  std::string path_;
  std::vector<std::string> overrides_;
  std::vector<Entry> problems_;
  std::vector<Entry> warnings_;
};

/// "; did you mean 'near'?" or "; known are a, b, c".
std::string advice(const std::string& name,
                   const std::vector<std::string>& known);

}  // namespace meniscus::case_data
