/// Inner nodes moved so that the worst elements get better.
#pragma once

#include "core/tet_mesh.h"

namespace meniscus {

struct SmoothOptions {
  double below_deg = 10.0;  // nodes of elements with a smaller dihedral angle
  int sweeps = 10;          // at most
};

/// Maximises, node after node, the smallest sine of a dihedral angle among the
/// node's elements (Freitag and Ollivier-Gooch 1997, here by pattern search),
/// so that no element gets worse than the worst of its neighbourhood. `mesh`
/// is of order 1 with positive volumes; its first `fixed` nodes stay. Returns
/// the number of nodes that moved. Deterministic.
int smooth_inner_nodes(TetMesh& mesh, int fixed, const SmoothOptions& options);

}  // namespace meniscus
