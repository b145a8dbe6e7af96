// What is no curve.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_copy.h"

namespace meniscus::curves {

namespace {

[[noreturn]] void refuse(const Curve& curve, const std::string& what) {
  throw InvalidInput(fmt::format("curve '{}': {}", curve.name, what));
}

void require_positive(const Curve& curve, const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    refuse(curve, fmt::format("{} is {}, must be above 0", name, value));
  }
}

void require_finite(const Curve& curve, const char* name, const Vec3& value) {
  if (!value.allFinite()) {
    refuse(curve, fmt::format("{} is ({}, {}, {}), must be finite", name,
                              value.x(), value.y(), value.z()));
  }
}

void require_direction(const Curve& curve, const char* name,
                       const Vec3& value) {
  require_finite(curve, name, value);
  if (!(value.stableNorm() > 0.0)) {
    refuse(curve, fmt::format("{} is zero; give a direction", name));
  }
}

void require_axis(const Curve& curve, const Vec3& axis, const Vec3& normal) {
  require_direction(curve, "axis", axis);
  if (axis.normalized().cross(normal.normalized()).norm() < 1e-9) {
    refuse(curve, "axis is parallel to normal; give a direction in the plane");
  }
}

void validate_shape(const Curve& curve, const Circle& c) {
  require_finite(curve, "center", c.center);
  require_direction(curve, "normal", c.normal);
  require_positive(curve, "radius", c.radius);
}

void validate_shape(const Curve& curve, const Ellipse& e) {
  require_finite(curve, "center", e.center);
  require_direction(curve, "normal", e.normal);
  require_axis(curve, e.axis, e.normal);
  require_positive(curve, "radius_1", e.radius_1);
  require_positive(curve, "radius_2", e.radius_2);
}

void validate_shape(const Curve& curve, const Rectangle& r) {
  require_finite(curve, "center", r.center);
  require_direction(curve, "normal", r.normal);
  require_axis(curve, r.axis, r.normal);
  require_positive(curve, "width", r.width);
  require_positive(curve, "height", r.height);
  const double most = 0.5 * std::min(r.width, r.height);
  if (!std::isfinite(r.corner_radius) || r.corner_radius < 0.0 ||
      r.corner_radius > most * (1.0 - 1e-9)) {
    refuse(curve, fmt::format("corner_radius is {}, must be 0 or more and "
                              "below half the shorter side, {}",
                              r.corner_radius, most));
  }
}

/// Three points or more, finite, no two neighbours equal.
void require_points(const Curve& curve, const char* kind,
                    const Points& points) {
  if (points.size() < 3) {
    refuse(curve, fmt::format("{} has {} points, must have 3 or more", kind,
                              points.size()));
  }
  for (const Vec3& point : points) {
    require_finite(curve, "a point", point);
  }
  const double size = bounding_diagonal(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t next = (i + 1) % points.size();
    if ((points[next] - points[i]).norm() <= 1e-12 * size) {
      refuse(curve, fmt::format("points {} and {} are equal at ({}, {}, {}); "
                                "the {} closes by itself",
                                i, next, points[i].x(), points[i].y(),
                                points[i].z(), kind));
    }
  }
}

void validate_shape(const Curve& curve, const Polygon& p) {
  require_points(curve, "polygon", p.points);
}

void validate_shape(const Curve& curve, const Spline& s) {
  require_points(curve, "spline", s.points);
}

// Sine of the angle at an arc's middle point, from which on it is a line.
constexpr double kStraight = 1e-6;

void validate_shape(const Curve& curve, const Polyline& p) {
  Points all;
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    all.push_back(p.corners[k]);
    if (p.via[k]) {
      all.push_back(*p.via[k]);
    }
  }
  require_points(curve, "polyline", all);
  if (p.corners.size() < 2) {
    refuse(curve, "polyline has one corner; a full round is a circle");
  }
  for (std::size_t k = 0; k < p.corners.size(); ++k) {
    const Vec3& from = p.corners[k];
    const Vec3& to = p.corners[(k + 1) % p.corners.size()];
    if (!p.via[k]) {
      continue;
    }
    const Vec3& via = *p.via[k];
    if ((to - from).norm() <= 1e-12 * bounding_diagonal(all) ||
        (via - from).cross(to - via).norm() <=
            kStraight * (via - from).norm() * (to - via).norm()) {
      refuse(curve,
             fmt::format("the arc through ({}, {}, {}) has its three points on "
                         "a line; move that one, or take it out for a straight "
                         "side",
                         via.x(), via.y(), via.z()));
    }
  }
}

void validate_shape(const Curve& curve, const CurveCopy& c) {
  if (c.of == nullptr) {
    refuse(curve, "is a copy of nothing");
  }
  for (int k = 0; k < 3; ++k) {
    require_positive(curve, "scale", c.scale[k]);
  }
  if (c.mirror) {
    require_direction(curve, "mirror", *c.mirror);
  }
  require_direction(curve, "axis", c.axis);
  require_finite(curve, "about", c.about);
  require_finite(curve, "move", c.move);
  if (!std::isfinite(c.angle)) {
    refuse(curve, fmt::format("rotate is {}, must be finite", c.angle));
  }
  validate({c.of->name, c.of->shape});
  if (!c.offset) {
    return;
  }
  if (!std::isfinite(*c.offset)) {
    refuse(curve, fmt::format("offset is {}, must be finite", *c.offset));
  }
  try {
    validate({c.of->name, curve_shape::base_of(c)});
  } catch (const InvalidInput& error) {
    refuse(curve, fmt::format("offset by {}: {}", *c.offset, error.what()));
  }
}

void validate_shape(const Curve& curve, const ParametricCurve& p) {
  for (const Expression& coordinate : p.coordinates) {
    const std::vector<int> used = coordinate.names_used();
    if (!used.empty() && used != std::vector<int>{0}) {
      refuse(curve,
             fmt::format("'{}' has more names than t", coordinate.text()));
    }
  }
}

}  // namespace

void validate(const Curve& curve) {
  std::visit([&](const auto& shape) { validate_shape(curve, shape); },
             curve.shape);
}

}  // namespace meniscus::curves
