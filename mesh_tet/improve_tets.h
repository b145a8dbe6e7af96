/// The worst elements of a tetrahedral mesh made better, its surface kept.
#pragma once

#include "core/geometry/tet_mesh.h"

namespace meniscus::mesh_tet {

struct ImproveOptions {
  double below_deg = 10.0;  // elements with a smaller dihedral angle, or one
                            // nearer to 180 degrees than this
  int rounds = 6;           // over the bad elements, at most
};

struct ImproveReport {
  int moved = 0;    // nodes, counted once a move
  int flipped = 0;  // edges or faces removed
  int added = 0;    // nodes, on edges or in cavities
};

/// Maximises the smallest sine of a dihedral angle, element by bad element
/// (Freitag and Ollivier-Gooch 1997): moves inner nodes (by pattern search),
/// removes inner edges with up to 7 elements around (the best of all
/// triangulations of their ring, Klincsek 1980) and faces, splits inner edges,
/// puts nodes into cavities.
/// Every step makes the worst element that it touches better.
/// `mesh` is of order 1 with positive volumes; its first `fixed` nodes and its
/// faces stay, new nodes come last. Element numbers change: face_element must
/// be found again. Deterministic.
ImproveReport improve_tets(TetMesh& mesh, int fixed,
                           const ImproveOptions& options);

}  // namespace meniscus::mesh_tet
