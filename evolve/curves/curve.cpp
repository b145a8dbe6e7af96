#include "evolve/curves/curve.h"

#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>

#include <Eigen/Geometry>

#include "core/error.h"
#include "evolve/curves/arc_side.h"
#include "evolve/curves/curve_copy.h"
#include "evolve/curves/spline_curve.h"

namespace meniscus::curves {

namespace {

using curve_shape::Frame;
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

Vec3 point_on(const Polyline& p, Place at) {
  const std::size_t next = (at.part + 1) % p.corners.size();
  const std::optional<Vec3>& via = p.via[at.part];
  if (via && at.s > 0.0) {
    return curve_shape::arc_through<double>(p.corners[at.part], *via,
                                            p.corners[next])
        .at(at.s);
  }
  return (1.0 - at.s) * p.corners[at.part] + at.s * p.corners[next];
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

bool equal(const Circle& a, const Circle& b) {
  return a.center == b.center && a.normal == b.normal && a.radius == b.radius;
}

bool equal(const Ellipse& a, const Ellipse& b) {
  return a.center == b.center && a.normal == b.normal && a.axis == b.axis &&
         a.radius_1 == b.radius_1 && a.radius_2 == b.radius_2;
}

bool equal(const Rectangle& a, const Rectangle& b) {
  return a.center == b.center && a.normal == b.normal && a.axis == b.axis &&
         a.width == b.width && a.height == b.height &&
         a.corner_radius == b.corner_radius;
}

bool equal(const Polygon& a, const Polygon& b) { return a.points == b.points; }

bool equal(const ParametricCurve&, const ParametricCurve&) { return false; }

bool equal(const Spline& a, const Spline& b) { return a.points == b.points; }

bool equal(const Polyline& a, const Polyline& b) {
  return a.corners == b.corners && a.via == b.via;
}

bool equal(const CurveCopy& a, const CurveCopy& b) {
  return are_equal(a.of->shape, b.of->shape) && a.offset == b.offset &&
         a.scale == b.scale && a.mirror == b.mirror && a.angle == b.angle &&
         a.axis == b.axis && a.about == b.about && a.move == b.move;
}

}  // namespace

bool are_equal(const CurveShape& a, const CurveShape& b) {
  return a.index() == b.index() &&
         std::visit(
             [&](const auto& one) {
               return equal(one, std::get<std::decay_t<decltype(one)>>(b));
             },
             a);
}

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
      "films can slide along circles, ellipses and parametric curves only; use "
      "one of these");
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

Vec3 point_at(const CurveShape& shape, double t) {
  return std::visit(
      [&](const auto& s) -> Vec3 {
        using Shape = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<Shape, ParametricCurve>) {
          return point_on(s, t);
        } else if constexpr (std::is_same_v<Shape, Spline> ||
                             std::is_same_v<Shape, CurveCopy>) {
          return points_at(shape, {t}).front();
        } else {
          return point_on(s, curve_shape::place_of(shape, t));
        }
      },
      shape);
}

Points points_at(const CurveShape& shape, const std::vector<double>& t) {
  if (const auto* copy = std::get_if<CurveCopy>(&shape)) {
    return curve_shape::points_on(*copy, t);
  }
  Points result;
  result.reserve(t.size());
  if (const auto* spline = std::get_if<Spline>(&shape)) {
    const curve_shape::SplineCurve<double> curve(spline->points);
    for (const double at : t) {
      result.push_back(curve.at(at));
    }
    return result;
  }
  for (const double at : t) {
    result.push_back(point_at(shape, at));
  }
  return result;
}

}  // namespace meniscus::curves
