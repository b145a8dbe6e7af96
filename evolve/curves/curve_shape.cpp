#include "evolve/curves/curve_shape.h"

#include <algorithm>

namespace meniscus::curves::curve_shape {

int part_count(const CurveShape& shape) {
  if (const auto* r = std::get_if<Rectangle>(&shape)) {
    return r->corner_radius > 0.0 ? 8 : 4;
  }
  if (const auto* p = std::get_if<Polygon>(&shape)) {
    return static_cast<int>(p->points.size());
  }
  if (const auto* p = std::get_if<Polyline>(&shape)) {
    return static_cast<int>(p->corners.size());
  }
  if (const auto* copy = std::get_if<CurveCopy>(&shape)) {
    return part_count(copy->of->shape);
  }
  return 1;
}

Place place_of(const CurveShape& shape, double t) {
  const int parts = part_count(shape);
  const double along = (t - std::floor(t)) * parts;
  const int part = std::min(static_cast<int>(along), parts - 1);
  return {part, along - part};
}

InPlane in_plane(const Rectangle& r, const Rectangle& kind, Place at) {
  const double x = 0.5 * r.width - r.corner_radius;
  const double y = 0.5 * r.height - r.corner_radius;
  const bool round = kind.corner_radius > 0.0;
  const int side = round ? at.part / 2 : at.part;
  constexpr std::array<std::array<double, 2>, 5> kCorner = {
      {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  const auto& from = kCorner[side];
  const auto& to = kCorner[side + 1];
  const bool arc = round && at.part % 2 == 1;
  const double angle = 0.5 * std::numbers::pi * (side + (arc ? at.s : 0.0));
  const double w = arc ? 1.0 : at.s;
  const double px = x * ((1.0 - w) * from[0] + w * to[0]);
  const double py = y * ((1.0 - w) * from[1] + w * to[1]);
  return {px + r.corner_radius * std::cos(angle),
          py + r.corner_radius * std::sin(angle)};
}

}  // namespace meniscus::curves::curve_shape
