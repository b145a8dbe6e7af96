#include "core/geometry/plane_points.h"

#include <algorithm>

namespace meniscus {

std::array<double, 2> segment_sides(const Vec2& a, const Vec2& b, const Vec2& c,
                                    const Vec2& d) {
  const Vec2 first = b - a;
  const Vec2 second = d - c;
  return {cross2(first, c - a) * cross2(first, d - a),
          cross2(second, a - c) * cross2(second, b - c)};
}

std::optional<double> segment_crossing(const Vec2& a, const Vec2& b,
                                       const Vec2& c, const Vec2& d) {
  constexpr double kOnLine = 1e-12;  // x the squared extent
  Eigen::AlignedBox2d box(a);
  box.extend(b).extend(c).extend(d);
  const double zero = kOnLine * box.diagonal().squaredNorm();
  const auto apart = [zero](double one, double other) {
    return (one > zero && other < -zero) || (one < -zero && other > zero);
  };
  const double from = cross2(d - c, a - c);
  const double to = cross2(d - c, b - c);
  if (!apart(from, to) || !apart(cross2(b - a, c - a), cross2(b - a, d - a))) {
    return std::nullopt;
  }
  return from / (from - to);
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double length2 = way.squaredNorm();
  const double share =
      length2 > 0.0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (a + share * way - p).norm();
}

Eigen::AlignedBox2d box_of(const std::vector<Vec2>& points) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : points) {
    box.extend(p);
  }
  return box;
}

}  // namespace meniscus
