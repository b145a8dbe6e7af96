/// Joins the facets of a convex hull to the rims that lie on it.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::start {

/// The hull knows only corners: the points inside straight sides are put back
/// into the facets along them.
class RimStitcher {
 public:
  /// Keeps references; `facets` is changed by stitch().
  RimStitcher(const Points& points, std::vector<Triangle>& facets);

  /// Returns a point that is off the hull, or -1 when the facets end at every
  /// piece of the rim first, first + 1, ... of n points.
  int stitch(int first, int n);

  std::size_t open_edges() const;

 private:
  void list(int f);
  int stitch_side(const std::vector<int>& chain);

  const Points& points_;
  std::vector<Triangle>& facets_;
  double reach_;
  std::vector<char> used_;    // per point: a hull corner
  std::map<Edge, int> side_;  // directed edge -> facet
};

}  // namespace meniscus::start
