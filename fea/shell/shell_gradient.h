/// How the stiffness of a shell changes with its nodes and thicknesses: the
/// part of an adjoint gradient that belongs to the state equation.
#pragma once

#include <vector>

#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

struct ShellGradient {
  double value = 0.0;              // v . K u
  Points by_nodes;                 // one per node [of value / length]
  std::vector<Vec3> by_thickness;  // at each facet's corners [the same]
};

/// v . K(x, t) u and its derivatives, u and v (6 per node) held. With u = v the
/// solution under loads that do not change, the compliance falls by the
/// gradient. Exact, by a tape over each facet (core/math/taped.h); the same
/// bits for any number of threads. Throws as ShellSystem does, and InvalidInput
/// for vectors of another length.
ShellGradient stiffness_gradient(const ShellMesh& mesh,
                                 const std::vector<Section>& sections,
                                 const VectorX& v, const VectorX& u);

}  // namespace meniscus::shell
