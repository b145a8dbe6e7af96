/// Mean normals of a film at the nodes of its shell.
#pragma once

#include <map>

#include "pipeline/shells/shell_part.h"

namespace meniscus::shells {

/// Of the facets of that label of the skin, at their nodes, each weighed by the
/// size of the facet there: unit vectors.
std::map<int, Vec3> film_normals(const ShellPart& part, int label);

}  // namespace meniscus::shells
