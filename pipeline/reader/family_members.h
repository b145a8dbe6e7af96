/// The members of a family as cases of their own.
#pragma once

#include <string>
#include <vector>

#include "pipeline/reader/case_reader.h"

namespace meniscus::reader {

/// The member's case: that of the family with the member's overrides after the
/// family's own, and its study of kind study.each. Problems read "PLACE: member
/// 'NAME': ...", PLACE being the member's own (csv files too).
CaseReading read_family_member(const case_data::Case& family,
                               const case_data::MemberEntry& member);

/// Of all members, at most 20 and how many more; none for other studies.
std::vector<std::string> member_problems(const case_data::Case& family);

/// All members in order; `family` was read without problems.
std::vector<case_data::Case> family_cases(const case_data::Case& family);

/// What tells one member from another, for family_tree(): parameters at the
/// initial design, initial design, bounds.
VectorX member_numbers(const case_data::Case& member);

}  // namespace meniscus::reader
