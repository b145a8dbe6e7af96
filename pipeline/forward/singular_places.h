/// Where the stress of a part has no limit, and what that means for figures of
/// stress.
#pragma once

#include <vector>

#include "fea/stress/singular_edges.h"
#include "pipeline/case_data/case.h"
#include "pipeline/forward/forward_model.h"

namespace meniscus::forward {

/// How far the errors of stress figures look ahead, to edges so many times
/// shorter, where stress grows with every refinement.
inline constexpr double kShorterEdges = 4.0;

/// Of the supports of a load case: grooves, and the rims of what it holds.
std::vector<stress::SingularEdge> singular_edges_of(
    const EvaluationFields& fields, std::size_t load_case);

/// How much more a von_mises_norm or von_mises_ks would be with edges
/// kShorterEdges times shorter, as if in elements at singular edges a part of
/// 1 / kShorterEdges^2 had the stress that the edge's order says [pressure],
/// >= 0; 0 for other kinds. `fields`: with stresses.
double growth_of_mean(const case_data::ResponseEntry& response,
                      const EvaluationFields& fields);

}  // namespace meniscus::forward
