/// How well shaped four-node tetrahedra are.
#pragma once

#include <array>

#include "core/tet_mesh.h"

namespace meniscus {

struct TetQuality {
  double min_dihedral_deg = 0.0;
  double max_dihedral_deg = 0.0;
  double max_radius_edge = 0.0;  // circumradius over shortest edge
  double max_aspect = 0.0;       // longest edge over smallest height
  double min_volume = 0.0;       // [length^3]
  int worst_element = -1;        // the one with the smallest dihedral angle
};

/// Over all elements, by their corners (any order of mesh).
TetQuality tet_quality(const TetMesh& mesh);

/// Corners of a tetrahedron's faces, counter-clockwise from outside when its
/// volume is positive; face i lies opposite to corner i.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

using TetCorners = std::array<Vec3, 4>;

/// Signed volume [length^3].
double tet_volume(const TetCorners& x);

/// Cosines of the dihedral angles at the edges of kTetEdges; 1 where a face
/// has no area. Of the unsigned angles: look at the volume's sign first.
std::array<double, 6> dihedral_cosines(const TetCorners& x);

}  // namespace meniscus
