/// Edges at which two outer faces of a mesh meet, and their angle.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/face_points.h"

namespace meniscus::element {

struct OuterEdge {
  Edge corners{};              // ascending
  std::array<int, 2> face{};   // ascending
  std::array<int, 2> place{};  // of the edge's middle among each face's nodes;
                               // order 1: of its first node
};

/// By their corners, ascending. Edges of more than two outer faces, where
/// bodies touch in a line, are left out; so are interfaces' faces.
std::vector<OuterEdge> outer_edges(const TetMesh& mesh);

/// How far the surface turns into the material at an edge's middle [rad],
/// between -pi and pi: 0 where the faces are flush, above 0 in a groove, below
/// on a ridge; the material has that and pi.
struct Turn {
  double value = 0.0;
  /// By the two faces' normals as FaceQuadrature gives them, of any length.
  std::array<Vec3, 2> by_normal;
};

/// `at_nodes`: of the mesh's order and FaceRule::Nodes.
Turn turn_of(const TetMesh& mesh, const FaceQuadrature& at_nodes,
             const OuterEdge& edge);

}  // namespace meniscus::element
