/// Points, segments and polygons of a plane.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace meniscus {

using Vec2 = Eigen::Vector2d;

/// a x b: twice the area of the triangle 0, a, b; above 0 where it runs
/// counter-clockwise.
inline double cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// On which sides of each of the segments a-b and c-d the other's ends lie:
/// both below 0 where they cross, one 0 where an end lies on the other's line.
std::array<double, 2> segment_sides(const Vec2& a, const Vec2& b, const Vec2& c,
                                    const Vec2& d);

/// Where two segments cross, as the share of the way from a to b; none where
/// they only touch, or lie on one line but for rounding.
std::optional<double> segment_crossing(const Vec2& a, const Vec2& b,
                                       const Vec2& c, const Vec2& d);

/// How far p is from the segment a-b [length].
double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b);

/// The box around points; empty for none.
Eigen::AlignedBox2d box_of(const std::vector<Vec2>& points);

}  // namespace meniscus
