/// Reads and checks a case file. Nothing is computed but the numbers of the
/// initial design and of both ends of each design variable.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/case_data/case.h"

namespace meniscus::reader {

/// All that was found: a case when there are no problems. Each problem and
/// warning reads "PATH:LINE: what, found, expected, try"; one that an override
/// made reads "PATH: --set NAME=VALUE: ...".
struct CaseReading {
  std::optional<case_data::Case> input;
  std::vector<std::string> problems;  // at most 20, and how many more
  std::vector<std::string> warnings;
};

/// `overrides`: "name=value" with the name of a parameter, of a design variable
/// (its initial value) or a dotted key ("resolution.fea"); the value as it
/// would stand in the file, quotes may be left out.
CaseReading read_case_file(const std::string& path,
                           const std::vector<std::string>& overrides = {});

/// The same from text; `path` for messages. Files that the case names are taken
/// from `files` where they are there, else from disk beside `path`.
CaseReading read_case_text(const std::string& text, const std::string& path,
                           const std::vector<std::string>& overrides = {},
                           std::vector<case_data::CaseFile> files = {});

/// The case, or InvalidInput with all problems, one a line.
case_data::Case read_case(const std::string& path,
                          const std::vector<std::string>& overrides = {});

}  // namespace meniscus::reader
