/// The members of a family from a csv file.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case_entries.h"

namespace meniscus::members {

/// Of one table of members that are told; more are counted.
inline constexpr std::size_t kMostProblems = 20;

struct MemberFile {
  std::vector<case_data::MemberEntry> members;  // in the order of the rows
  std::vector<std::string> problems;  // "FILE:LINE: what, found, expected, try"
};

/// RFC 4180 (commas, quotes where a cell holds one; blank lines are skipped).
/// The head row names the columns: `name`, then whatever --set takes; a pair
/// NAME.lower, NAME.upper stands for design.NAME.bounds = [lower, upper]. An
/// empty cell leaves the case's own value. `path`: as messages name it; empty
/// text is a problem.
MemberFile read_member_text(const std::string& text, const std::string& path);

/// The same from a file; one that cannot be read is a problem.
MemberFile read_member_file(const std::string& path);

/// The name makes a folder: letters, digits, _ and -, at most 80.
bool is_member_name(const std::string& name);

}  // namespace meniscus::members
