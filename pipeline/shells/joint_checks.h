/// What shells and solids of one case cannot do beside each other.
#pragma once

#include <string>

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_problems.h"

namespace meniscus::shells {

/// A film of shells, its back or a rim of it; ends in planes of symmetry, too.
bool is_on_shells(const case_data::Case& input, const std::string& surface);

/// Notes it, and what can be done instead. Of a case with shells and solids.
void check_joint(const case_data::Case& input,
                 case_data::CaseProblems& problems);

}  // namespace meniscus::shells
