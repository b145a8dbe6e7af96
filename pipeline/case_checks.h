/// Checks of a case beyond the form of its keys: names that refer to each
/// other, bodies that close, numbers that make sense.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case.h"

namespace meniscus {

/// Problems and warnings of one file, in order of line.
class CaseProblems {
 public:
  explicit CaseProblems(std::string path) : path_(std::move(path)) {}

  void add(int line, const std::string& message);
  void add_text(const std::string& message);  // that names its place itself
  void warn(int line, const std::string& message);
  /// "there is no material 'x'; did you mean 'y'?"
  void unknown(int line, const char* what, const std::string& name,
               const std::vector<std::string>& known);
  bool empty() const { return problems_.empty(); }
  std::vector<std::string> take();  // at most 20
  std::vector<std::string> take_warnings();

 private:
  struct Entry {
    int line;
    std::string text;
  };
  std::string path_;
  std::vector<Entry> problems_;
  std::vector<Entry> warnings_;
};

void check_bounds(const DesignVariable& variable, int line,
                  CaseProblems& problems);

/// Sets `refinements`; film must be fea / 2^k.
void check_nesting(Resolution& resolution, int line, CaseProblems& problems);

/// A load, support or response acts on a solid surface or on a body's film.
void check_surface_name(const Case& input, const std::string& surface, int line,
                        CaseProblems& problems);

void check_study(const Case& input, CaseProblems& problems);

/// References between curves, films, solids and bodies; order of parameters
/// (sets `parameter_order`); the numbers at the initial design and at both
/// ends of every design variable.
void check_case(Case& input, CaseProblems& problems);

/// Study kinds of later versions.
bool is_later_study(const std::string& kind);

/// "two_arm" for "cases/two_arm/case.toml", else the file's stem.
std::string case_name(const std::string& path);

}  // namespace meniscus
