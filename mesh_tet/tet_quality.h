/// How well shaped four-node tetrahedra are.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/geometry/tet_mesh.h"

namespace meniscus::mesh_tet {

/// The worst of all elements, and which they are.
struct TetQuality {
  double min_dihedral_deg = 0.0;
  double max_dihedral_deg = 0.0;
  double max_radius_edge = 0.0;  // circumradius over shortest edge
  double max_aspect = 0.0;       // longest edge over smallest height
  double min_volume = 0.0;       // [length^3]
  int worst_element = -1;        // the one with the smallest dihedral angle
  int largest_dihedral_element = -1;
  int radius_edge_element = -1;
  int aspect_element = -1;
  /// Number of dihedral angles in [10 i, 10 i + 10) degrees, six an element.
  std::array<int, 18> dihedral_histogram{};
};

/// Over all elements, by their corners (any order of mesh).
TetQuality tet_quality(const TetMesh& mesh);

/// What a mesh must keep. The regular element has dihedral angles of 70.5
/// degrees, a radius-edge ratio of 0.61 and an aspect of 1.22.
struct QualityBounds {
  double min_dihedral_deg = 1.0;  // ten-node elements lose about a digit of
                                  // conditioning per decade of angle
  double max_dihedral_deg = 179.0;
  double max_radius_edge = 1000.0;
  double max_aspect = 2000.0;
};

/// The first bound that is broken.
struct QualityBreach {
  std::string what;  // measure, value and bound, in words
  int element = -1;
};
std::optional<QualityBreach> find_breach(const TetQuality& quality,
                                         const QualityBounds& bounds);

/// "near (x, y, z)", with the names of the surfaces that the element touches.
std::string place_of(const TetMesh& mesh, int element);

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

}  // namespace meniscus::mesh_tet
