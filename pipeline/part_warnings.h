/// Does the linear analysis of a part still hold?
#pragma once

#include <string>
#include <vector>

#include "pipeline/forward_model.h"

namespace meniscus {

/// Sentences for stress above yield (the place with the least safety factor,
/// each body against its own material) and for displacements that are not small
/// against the part. Looks at every load case.
std::vector<std::string> part_warnings(const Case& input,
                                       const EvaluationFields& fields);

}  // namespace meniscus
