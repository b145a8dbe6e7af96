/// What shells cannot do of what a case may ask.
#pragma once

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_problems.h"

namespace meniscus::shells {

/// Notes it, and what can be done instead. Of a case without other problems.
void check_shells(const case_data::Case& input,
                  case_data::CaseProblems& problems);

}  // namespace meniscus::shells
