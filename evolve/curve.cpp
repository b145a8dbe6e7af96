#include "evolve/curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/surface_mesh.h"
#include "evolve/curve_shape.h"

namespace meniscus {

namespace {

using curve_shape::Frame;
using curve_shape::part_count;
using curve_shape::Place;

constexpr double kPi = std::numbers::pi;

template <class Shape>
Vec3 point_on(const Shape& shape, Place at) {
  const Frame<double> f = curve_shape::frame_of(shape);
  const curve_shape::InPlane place = curve_shape::in_plane(shape, shape, at);
  return shape.center + place.a * f.u + place.b * f.v;
}

Vec3 point_on(const Circle& c, Place at) {  // rounded in this order
  const Frame<double> f = curve_shape::frame_of(c);
  const double a = 2.0 * kPi * at.s;
  return c.center + c.radius * (std::cos(a) * f.u + std::sin(a) * f.v);
}

Vec3 point_on(const Polygon& p, Place at) {
  const std::size_t next = (at.part + 1) % p.points.size();
  return (1.0 - at.s) * p.points[at.part] + at.s * p.points[next];
}

Dual dual_of(const Expression& expression, double t) {
  const std::array<Dual, 1> values = {Dual::variable(t, 0, 1)};
  return expression.evaluate(std::span<const Dual>(values));
}

Vec3 point_on(const ParametricCurve& p, double t) {
  const std::array<double, 1> values = {t};
  Vec3 point;
  for (int k = 0; k < 3; ++k) {
    point[k] = p.coordinates[k].evaluate(std::span<const double>(values));
  }
  return point;
}

CurveJet jet_of(const ParametricCurve& p, double t) {
  CurveJet jet{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < 3; ++k) {
    const Dual x = dual_of(p.coordinates[k], t);
    jet.point[k] = x.value;
    if (!x.is_constant()) {
      jet.first[k] = x.gradient[0];
      jet.second[k] = x.hessian(0, 0);
    }
  }
  return jet;
}

CurveJet jet_of(const Vec3& center, const Vec3& u, const Vec3& v, double t) {
  const double w = 2.0 * kPi;
  const Vec3 out = std::cos(w * t) * u + std::sin(w * t) * v;
  const Vec3 along = std::cos(w * t) * v - std::sin(w * t) * u;
  return {center + out, w * along, -w * w * out};
}

// Arclength of an ellipse from angle 0 at equal steps of the angle: 5-point
// Gauss on each step, exact to rounding for any usual ratio of radii.
std::vector<double> ellipse_lengths(const Ellipse& e) {
  constexpr int kSteps = 2048;
  constexpr std::array<double, 5> kAt = {-0.906179845938664, -0.538469310105683,
                                         0.0, 0.538469310105683,
                                         0.906179845938664};
  constexpr std::array<double, 5> kWeight = {
      0.236926885056189, 0.478628670499366, 0.568888888888889,
      0.478628670499366, 0.236926885056189};
  const double h = 2.0 * kPi / kSteps;
  std::vector<double> lengths(kSteps + 1, 0.0);
  for (int i = 0; i < kSteps; ++i) {
    double sum = 0.0;
    for (std::size_t g = 0; g < kAt.size(); ++g) {
      const double a = h * (i + 0.5 + 0.5 * kAt[g]);
      sum += kWeight[g] *
             std::hypot(e.radius_1 * std::sin(a), e.radius_2 * std::cos(a));
    }
    lengths[i + 1] = lengths[i] + 0.5 * h * sum;
  }
  return lengths;
}

double part_length(const CurveShape& shape, int part) {
  if (const auto* c = std::get_if<Circle>(&shape)) {
    return 2.0 * kPi * c->radius;
  }
  if (const auto* e = std::get_if<Ellipse>(&shape)) {
    return ellipse_lengths(*e).back();
  }
  if (const auto* r = std::get_if<Rectangle>(&shape)) {
    const bool round = r->corner_radius > 0.0;
    if (round && part % 2 == 1) {
      return 0.5 * kPi * r->corner_radius;
    }
    const int side = round ? part / 2 : part;
    return (side % 2 == 0 ? r->height : r->width) - 2.0 * r->corner_radius;
  }
  const Points& points = std::get<Polygon>(shape).points;
  return (points[(part + 1) % points.size()] - points[part]).norm();
}

std::vector<double> sample_ellipse(const Ellipse& e, int pieces) {
  const std::vector<double> lengths = ellipse_lengths(e);
  const double step = 1.0 / static_cast<double>(lengths.size() - 1);
  std::vector<double> result;
  std::size_t at = 0;
  for (int i = 0; i < pieces; ++i) {
    const double wanted = lengths.back() * i / pieces;
    while (lengths[at + 1] <= wanted) {
      ++at;
    }
    const double share =
        (wanted - lengths[at]) / (lengths[at + 1] - lengths[at]);
    result.push_back(step * (static_cast<double>(at) + share));
  }
  return result;
}

// Pieces per part: about `edge` long, at least one, an even number in all.
std::vector<int> pieces_per_part(const std::vector<double>& lengths,
                                 double edge, int least) {
  double total = 0.0;
  for (const double length : lengths) {
    total += length;
  }
  const double size = std::min(edge, total / least);
  std::vector<int> pieces;
  int sum = 0;
  for (const double length : lengths) {
    pieces.push_back(std::max(1, static_cast<int>(std::lround(length / size))));
    sum += pieces.back();
  }
  while (sum < least || sum % 2 != 0) {
    std::size_t coarsest = 0;
    for (std::size_t i = 1; i < lengths.size(); ++i) {
      if (lengths[i] / pieces[i] >
          (1.0 + 1e-9) * lengths[coarsest] / pieces[coarsest]) {
        coarsest = i;
      }
    }
    ++pieces[coarsest];
    ++sum;
  }
  return pieces;
}

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

void validate_shape(const Curve& curve, const Polygon& p) {
  if (p.points.size() < 3) {
    refuse(curve, fmt::format("polygon has {} points, must have 3 or more",
                              p.points.size()));
  }
  for (std::size_t i = 0; i < p.points.size(); ++i) {
    require_finite(curve, "a point", p.points[i]);
  }
  const double size = bounding_diagonal(p.points);
  for (std::size_t i = 0; i < p.points.size(); ++i) {
    const std::size_t next = (i + 1) % p.points.size();
    if ((p.points[next] - p.points[i]).norm() <= 1e-12 * size) {
      refuse(curve, fmt::format("points {} and {} are equal at ({}, {}, {}); "
                                "the polygon closes by itself",
                                i, next, p.points[i].x(), p.points[i].y(),
                                p.points[i].z()));
    }
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

constexpr int kMiddleSteps = 20;

// Newton on (x(t) - middle) . x'(t) = 0 from the better of two tangents.
double nearest_to_middle(const ParametricCurve& p, double a, double b) {
  const CurveJet start = jet_of(p, a);
  const CurveJet end = jet_of(p, b);
  const Vec3 middle = 0.5 * (start.point + end.point);
  const auto project = [&](const CurveJet& jet, double t) {
    const double speed2 = jet.first.squaredNorm();
    return speed2 > 0.0 ? t + (middle - jet.point).dot(jet.first) / speed2 : t;
  };
  double t = project(start, a);
  for (int step = 0; step < kMiddleSteps; ++step) {
    const CurveJet jet = jet_of(p, t);
    const Vec3 gap = jet.point - middle;
    const double slope = gap.dot(jet.first);
    const double bend = jet.first.squaredNorm() + gap.dot(jet.second);
    const double move = slope / (bend > 0.0 ? bend : jet.first.squaredNorm());
    if (!std::isfinite(move)) {
      return 0.5 * (a + b);
    }
    t -= move;
    if (std::abs(move) <= 1e-15 * (1.0 + std::abs(t))) {
      break;
    }
  }
  return t;
}

}  // namespace

CurveJet jet_at(const CurveShape& shape, double t) {
  if (const auto* p = std::get_if<ParametricCurve>(&shape)) {
    return jet_of(*p, t);
  }
  if (const auto* c = std::get_if<Circle>(&shape)) {
    const Frame<double> f = curve_shape::frame_of(*c);
    return jet_of(c->center, c->radius * f.u, c->radius * f.v, t);
  }
  if (const auto* e = std::get_if<Ellipse>(&shape)) {
    const Frame<double> f = curve_shape::frame_of(*e);
    return jet_of(e->center, e->radius_1 * f.u, e->radius_2 * f.v, t);
  }
  throw InvalidInput(
      "films cannot slide along a curve with corners; use a circle, an ellipse "
      "or a parametric curve");
}

double middle_parameter(const CurveShape& shape, double a, double b) {
  if (const auto* p = std::get_if<ParametricCurve>(&shape)) {
    return nearest_to_middle(*p, a, b);
  }
  double t = 0.5 * (a + b);
  if (std::abs(a - b) > 0.5) {
    t += t < 0.5 ? 0.5 : -0.5;
  }
  return t;
}

void validate(const Curve& curve) {
  std::visit([&](const auto& shape) { validate_shape(curve, shape); },
             curve.shape);
}

Vec3 point_at(const CurveShape& shape, double t) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>,
                                     ParametricCurve>) {
          return point_on(s, t);
        } else {
          return point_on(s, curve_shape::place_of(shape, t));
        }
      },
      shape);
}

double length_of(const CurveShape& shape) {
  double sum = 0.0;
  for (int part = 0; part < part_count(shape); ++part) {
    sum += part_length(shape, part);
  }
  return sum;
}

std::vector<double> sample_parameters(const CurveShape& shape, double edge,
                                      int least) {
  if (!std::isfinite(edge) || edge <= 0.0) {
    throw InvalidInput(fmt::format("edge length is {}, must be above 0", edge));
  }
  if (std::holds_alternative<ParametricCurve>(shape)) {
    throw InvalidInput("a parametric curve has no range to cut into edges");
  }
  const int parts = part_count(shape);
  std::vector<double> lengths(parts);
  for (int part = 0; part < parts; ++part) {
    lengths[part] = part_length(shape, part);
  }
  const std::vector<int> pieces = pieces_per_part(lengths, edge, least);
  if (const auto* e = std::get_if<Ellipse>(&shape)) {
    return sample_ellipse(*e, pieces.front());
  }
  std::vector<double> result;
  for (int part = 0; part < parts; ++part) {
    for (int i = 0; i < pieces[part]; ++i) {
      result.push_back((part + static_cast<double>(i) / pieces[part]) / parts);
    }
  }
  return result;
}

}  // namespace meniscus
