/// From the curves of a case to their numbers at one design.
#pragma once

#include <vector>

#include "evolve/film_system.h"
#include "pipeline/case_values.h"

namespace meniscus {

/// One per entry, in order; values, or rates. A value that makes no curve is
/// told in the problems of `values`.
std::vector<Curve> curves_of(const Case& input, const CaseValues& values);

/// Tells of curves that hold films or caps and touch or cross each other.
void check_meetings(const Case& input, const FilmSystem& system,
                    const CaseValues& values);

}  // namespace meniscus
