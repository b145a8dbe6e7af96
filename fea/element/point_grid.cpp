#include "fea/element/point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace meniscus::element {

PointGrid::PointGrid(Points points) : points_(std::move(points)) {
  Vec3 high = points_.front();
  low_ = high;
  for (const Vec3& x : points_) {
    low_ = low_.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Vec3 size = high - low_;
  const double count = static_cast<double>(points_.size());
  // Flat clouds have boxes as wide as their largest side allows.
  const double least = size.maxCoeff() / std::max(1.0, std::cbrt(count));
  width_ = least > 0.0 ? least : 1.0;
  for (int k = 0; k < 3; ++k) {
    boxes_[k] = static_cast<int>(size[k] / width_) + 1;
  }
  start_.assign(static_cast<std::size_t>(boxes_[0]) * boxes_[1] * boxes_[2] + 1,
                0);
  const auto index = [&](const Vec3& x) {
    const auto [i, j, k] = box_of(x);
    return (static_cast<std::size_t>(k) * boxes_[1] + j) * boxes_[0] + i;
  };
  for (const Vec3& x : points_) {
    ++start_[index(x) + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  sorted_.resize(points_.size());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    sorted_[next[index(points_[i])]++] = static_cast<int>(i);
  }
}

std::array<int, 3> PointGrid::box_of(const Vec3& x) const {
  std::array<int, 3> box;
  for (int k = 0; k < 3; ++k) {
    const double at = std::floor((x[k] - low_[k]) / width_);
    box[k] = static_cast<int>(std::clamp(at, 0.0, boxes_[k] - 1.0));
  }
  return box;
}

int PointGrid::of(const Vec3& x) const {
  const auto middle = box_of(x);
  // Distances count from the place in the grid next to x.
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  const int rings = *std::max_element(boxes_.begin(), boxes_.end());
  for (int ring = 0; ring < rings; ++ring) {
    // Boxes of this ring are no nearer than this to any x in the middle box;
    // an x outside the grid is farther still.
    const double reach = (ring - 1) * width_;
    if (best >= 0 && reach > 0.0 && least < reach * reach) {
      break;
    }
    const auto visit = [&](int i, int j, int k) {
      const std::size_t box =
          (static_cast<std::size_t>(k) * boxes_[1] + j) * boxes_[0] + i;
      for (int at = start_[box]; at < start_[box + 1]; ++at) {
        const int p = sorted_[at];
        const double d = (points_[p] - x).squaredNorm();
        if (d < least || (d == least && p < best)) {
          least = d;
          best = p;
        }
      }
    };
    const auto low = [&](int c) { return std::max(0, middle[c] - ring); };
    const auto high = [&](int c) {
      return std::min(boxes_[c] - 1, middle[c] + ring);
    };
    for (int k = low(2); k <= high(2); ++k) {
      for (int j = low(1); j <= high(1); ++j) {
        const bool whole =
            std::abs(k - middle[2]) == ring || std::abs(j - middle[1]) == ring;
        for (int i = low(0); i <= high(0); ++i) {
          if (whole || std::abs(i - middle[0]) == ring) {
            visit(i, j, k);
          }
        }
      }
    }
  }
  return best;
}

}  // namespace meniscus::element
