/// Rigid rims in the equations: facets on them work on the rims' motions.
#pragma once

#include <array>
#include <vector>

#include "fea/shell/facet_matrices.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

/// Between which seats the facets are; a rim's place is its point. Nothing of
/// sections and thicknesses.
ShellMesh on_seats(const ShellMesh& mesh, const ShellFreedom& freedom);

/// A facet's matrix by its seats' numbers. `facet`: its nodes.
FacetMatrix on_seats(const ShellFreedom& freedom,
                     const std::array<int, 6>& facet, const FacetMatrix& K);

/// A solution and an adjoint, with what they leave on the nodes: K u - f, and K
/// v less the functional's derivative by u; 6 per node.
struct RimPair {
  const VectorX& u;
  const VectorX& residual;
  const VectorX& v;
  const VectorX& adjoint_residual;
};

/// Adds to an adjoint gradient what rims do as nodes move: one that turns by w
/// displaces a node by w x dx more.
void add_rim_gradient(const std::vector<RigidRim>& rims, const RimPair& pair,
                      Points& by_nodes);

/// The same by a rim's point.
Vec3 by_rim_point(const RigidRim& rim, const RimPair& pair);

}  // namespace meniscus::shell
