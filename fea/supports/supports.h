/// What supports leave free.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/loads/load_case.h"
#include "fea/solver/node_freedom.h"

namespace meniscus::supports {

/// One direction that a node is held along.
struct HeldDirection {
  int node;
  Vec3 direction;      // unit
  double uncertainty;  // kExactDirection; of normals twice what the facets'
                       // normals around the node differ by, if more
  int support = -1;    // index in the load case; -1: a held node's, a spring's
};
inline constexpr double kExactDirection = 1e-6;

/// Of all supports and held nodes: fixed components first, then single nodes,
/// then normals. Throws InvalidInput: a surface that is unknown, has no normal
/// or, under symmetry, is no plane; axes that span none; a node that the mesh
/// has not, a direction without length.
std::vector<HeldDirection> held_directions(const TetMesh& mesh,
                                           const loads::LoadCase& load_case);

/// Which of the directions of one node, taken in their order, it is held along,
/// and what they span.
struct HeldSpan {
  int rank = 0;
  std::array<int, 3> index{};  // among the directions
  std::array<Vec3, 3> unit;    // orthonormal
};
HeldSpan held_span(const HeldDirection* first, const HeldDirection* last);

/// Projectors onto the free directions of the nodes that are held, in the
/// mesh's numbering. A node is held along the span of its directions, taken in
/// their order; each counts when it leaves the span of those before by more
/// than their uncertainty.
solver::NodeFreedom node_freedom(const TetMesh& mesh,
                                 std::vector<HeldDirection> held);

}  // namespace meniscus::supports
