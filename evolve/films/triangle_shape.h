/// Shape measures of single triangles.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/types.h"

namespace meniscus::films {

/// Tangent of a triangle's smallest angle (at most 60 degrees); 0 when
/// degenerate. Orders shapes as the angle does, for less work.
inline double smallest_tangent(const Vec3& a, const Vec3& b, const Vec3& c) {
  // It lies opposite the shortest side.
  const Vec3 ab = b - a;
  const Vec3 bc = c - b;
  const double la = bc.squaredNorm();
  const double lb = (a - c).squaredNorm();
  const double lc = ab.squaredNorm();
  const double below = 0.5 * (la + lb + lc) - std::min({la, lb, lc});
  return below > 0.0 ? ab.cross(bc).norm() / below : 0.0;
}

/// Smallest angle of a triangle [rad]; 0 when degenerate.
inline double smallest_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::atan(smallest_tangent(a, b, c));
}

}  // namespace meniscus::films
