/// What a case's study looks at, and how.
#pragma once

#include <vector>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// Indices of responses: of a match those that its targets are made of,
/// ascending; of a minimum the objective, then the constraints, and the second
/// objective of a front last; of tolerances all with derivatives.
std::vector<int> studied_responses(const Case& input);

/// The study's method is one that takes derivatives where there are any.
bool asks_for_gradients(const StudyEntry& study);

}  // namespace meniscus::case_data
