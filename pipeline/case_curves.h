/// From the curves of a case to their numbers at one design.
#pragma once

#include <vector>

#include "evolve/curve.h"
#include "pipeline/case_values.h"

namespace meniscus {

/// One per entry, in order; values, or rates. A value that makes no curve is
/// told in the problems of `values`.
std::vector<Curve> curves_of(const Case& input, const CaseValues& values);

}  // namespace meniscus
