/// The nearest of many points: a grid, for points that are spread evenly. What
/// is nearest on facets is asked of core/geometry/facet_tree.h.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"

namespace meniscus::element {

/// Points sorted into equal boxes, about one a box. Owns copies; safe to ask
/// from several threads.
class PointGrid {
 public:
  /// `points` must be finite and not empty.
  explicit PointGrid(Points points);

  /// Index of the nearest point; the lowest of several.
  int of(const Vec3& x) const;

 private:
  std::array<int, 3> box_of(const Vec3& x) const;

  Points points_;
  Vec3 low_;
  double width_ = 1.0;
  std::array<int, 3> boxes_{};
  std::vector<int> start_;
  std::vector<int> sorted_;
};

}  // namespace meniscus::element
