/// The shortest line between two sets of facets.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::films {

struct ShortestLine {
  double length = 0.0;
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
};

/// Closest points of two triangles that do not cross: least of corner to facet
/// and edge to edge (Ericson, Real-Time Collision Detection, 2005, 5.1).
ShortestLine shortest_line(const std::array<Vec3, 3>& a,
                           const std::array<Vec3, 3>& b);

/// Of all facets in `from` to all in `to`, neither empty. Two trees of boxes,
/// the nearer pairs first.
ShortestLine shortest_line(const SurfaceMesh& mesh,
                           const std::vector<int>& from,
                           const std::vector<int>& to);

}  // namespace meniscus::films
