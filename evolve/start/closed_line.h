/// A closed line of many points, and the few that stand for it.
#pragma once

#include "core/types.h"

namespace meniscus::start {

class ClosedLine {
 public:
  /// Three points or more, in order; it closes by itself.
  explicit ClosedLine(Points points);

  double length() const { return along_.back(); }  // [length]

  /// `count` >= 4 points evenly along the line's Fourier series by its length,
  /// of less than `count` / 2 waves: noise of shorter waves is gone.
  Points smoothed(int count) const;

  /// Root of the mean square distance of the line's points to the closed cubic
  /// through `points` [length].
  double deviation(const Points& points) const;

 private:
  Points points_;
  std::vector<double> along_;  // from the first point; the whole length last
};

/// The plane that points are nearest to.
struct MeanPlane {
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // closed points run counter-clockwise about it
  double off = 0.0;             // root of the mean square distance [length]
};
MeanPlane mean_plane(const Points& points);

}  // namespace meniscus::start
