/// A band around a cylinder cut open, to be filled in a plane.
#pragma once

#include <array>
#include <vector>

#include "evolve/films/bent_wall.h"

namespace meniscus::films {

/// Unrolled (R t, z, 0), t the angle about the axis.
struct TubeStrip {
  Points rim;                 // a simple polygon
  std::vector<Points> holes;  // within it
  Points seam;  // made along the cut, each on both of its sides in the rim
  /// Of the points of the rim, then the holes': numbers of the loops' points,
  /// in order, then of the seam's.
  std::vector<int> ids;
};

/// Between two loops around the axis, `ends` of all loops, the others being
/// holes. The rim runs along the first end in its direction; the seam is the
/// shortest line from end to end that is clear of holes, in pieces of about
/// `edge` [length]. Throws MeshError where none is.
TubeStrip cut_open(const BentWall& wall, const std::vector<Points>& loops,
                   const std::array<std::size_t, 2>& ends, double edge);

}  // namespace meniscus::films
