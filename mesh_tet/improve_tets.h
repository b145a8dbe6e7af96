/// The worst elements of a tetrahedral mesh made better, its surface kept.
#pragma once

#include "core/tet_mesh.h"

namespace meniscus {

struct ImproveOptions {
  double below_deg = 10.0;  // elements with a smaller dihedral angle
  int rounds = 6;           // of moving nodes and splitting edges, at most
};

struct ImproveReport {
  int moved = 0;  // nodes, counted once a move
  int split = 0;  // edges
};

/// Moves inner nodes to maximise the smallest sine of a dihedral angle among
/// their elements (Freitag and Ollivier-Gooch 1997, here by pattern search).
/// A bad element whose nodes cannot move gets a new node on an inner edge,
/// which then moves; kept when the worst of the edge's elements gets better.
/// `mesh` is of order 1 with positive volumes; its first `fixed` nodes and the
/// faces among them stay, new elements come last: face_element must be found
/// again when edges were split. Deterministic.
ImproveReport improve_tets(TetMesh& mesh, int fixed,
                           const ImproveOptions& options);

}  // namespace meniscus
