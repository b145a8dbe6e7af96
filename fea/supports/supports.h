/// What supports leave free.
#pragma once

#include <algorithm>
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
  int component = -1;  // of that support, 0 to 2; -1: its normal
  double value = 0.0;  // displacement along it [length]
};
inline constexpr double kExactDirection = 1e-6;

/// Of all supports and held nodes: fixed components first, then single nodes,
/// then normals; the nodes of pins are left to these. Throws InvalidInput: a
/// surface that is unknown, has no normal or, under symmetry, is no plane; axes
/// that span none; a node that the mesh has not, a direction without length; a
/// node on a pin that the pin moves otherwise than its support allows; pins as
/// pin_frames().
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

/// visit(first, last, span) for each node that is held, ascending.
template <class Visit>
void over_held_nodes(std::vector<HeldDirection> held, const Visit& visit) {
  std::stable_sort(held.begin(), held.end(),
                   [](const HeldDirection& a, const HeldDirection& b) {
                     return a.node < b.node;
                   });
  for (std::size_t k = 0; k < held.size();) {
    std::size_t end = k;
    while (end < held.size() && held[end].node == held[k].node) {
      ++end;
    }
    const HeldDirection* first = held.data() + k;
    visit(first, held.data() + end, held_span(first, held.data() + end));
    k = end;
  }
}

/// Columns of D (D^T D)^-1, D the directions that count: D^T u = d has the
/// shortest u = sum of d_k times column k.
std::array<Vec3, 3> dual_directions(const HeldDirection* first,
                                    const HeldSpan& span);

/// Projectors onto the free directions of the nodes that are held, in the
/// mesh's numbering. A node is held along the span of its directions, taken in
/// their order; each counts when it leaves the span of those before by more
/// than their uncertainty.
solver::NodeFreedom node_freedom(const TetMesh& mesh,
                                 std::vector<HeldDirection> held);

}  // namespace meniscus::supports
