/// What supports leave free.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/load_case.h"
#include "fea/node_freedom.h"

namespace meniscus {

/// One direction that a node is held along.
struct HeldDirection {
  int node;
  Vec3 direction;      // unit
  double uncertainty;  // kExactDirection; of normals twice what the facets'
                       // normals around the node differ by, if more
};
inline constexpr double kExactDirection = 1e-6;

/// Of all supports: fixed components first, then normals. Throws InvalidInput:
/// a surface that is unknown, has no normal or, under symmetry, is no plane;
/// axes that span none.
std::vector<HeldDirection> held_directions(const TetMesh& mesh,
                                           const LoadCase& load_case);

/// Projectors onto the free directions of the nodes that are held, in the
/// mesh's numbering. A node is held along the span of its directions, taken in
/// their order; each counts when it leaves the span of those before by more
/// than their uncertainty.
NodeFreedom node_freedom(const TetMesh& mesh, std::vector<HeldDirection> held);

}  // namespace meniscus
