/// Lines of a shell: rims and edges that facets share.
#pragma once

#include <array>
#include <vector>

#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Edges of facets: from, to, middle.
using Line = std::vector<std::array<int, 3>>;

double line_length(const ShellMesh& mesh, const Line& line);  // [length]

/// A mean over a line and its derivatives, all else held.
struct LineMean {
  double value = 0.0;
  Points by_nodes;          // one per node [of value / length]
  VectorX by_displacement;  // 6 per node
  Vec3 by_direction = Vec3::Zero();
};

/// Mean of u . d along the line by its length, d the direction made unit.
/// `displacement`: 6 per node. Throws InvalidInput for a direction or a line
/// without length.
LineMean mean_displacement(const ShellMesh& mesh, const Line& line,
                           const Vec3& direction, const VectorX& displacement);

}  // namespace meniscus::shell
