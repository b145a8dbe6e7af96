#include "evolve/curves/curve_copy.h"

#include <type_traits>

#include "core/error.h"
#include "evolve/curves/arc_side.h"
#include "evolve/curves/spline_curve.h"

namespace meniscus::curves::curve_shape {

namespace {

// Points of the spline that stands for an offset ellipse: off it by less than
// 1e-7 of its size at radii of 1 and 3.
constexpr int kEllipsePoints = 192;

Dual1 moving(double value, double rate) {
  Dual1 result = Dual1::variable(value, 0);
  result.gradient[0] = rate;
  return result;
}

Vector1 moving(const Vec3& value, const Vec3& rate) {
  return {moving(value.x(), rate.x()), moving(value.y(), rate.y()),
          moving(value.z(), rate.z())};
}

std::vector<Vector1> moving(const Points& points, const Points* rates) {
  std::vector<Vector1> result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    result.push_back(
        moving(points[k], rates != nullptr ? (*rates)[k] : Vec3::Zero()));
  }
  return result;
}

Vec3 value_of(const Vector1& v) { return {v[0].value, v[1].value, v[2].value}; }
Vec3 rate_of(const Vector1& v) {
  return {v[0].gradient[0], v[1].gradient[0], v[2].gradient[0]};
}

/// Along the (mean) plane's normal, counter-clockwise seen from its tip.
Vector1 plane_normal(const std::vector<Vector1>& corners) {
  Vector1 sum = Vec3(Vec3::Zero()).cast<Dual1>();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Vector1 a = corners[k] - corners[0];
    const Vector1 b = corners[k + 1] - corners[0];
    sum = Vector1(sum + a.cross(b));
  }
  return unit<Dual1>(sum);
}

/// Out of the curve, from its direction and its plane's normal.
Vector1 outward(const Vector1& along, const Vector1& normal) {
  const Vector1 out = along.cross(normal);
  return unit<Dual1>(out);
}

/// Where the offsets by 1 of two sides meet, seen from their corner.
Vector1 mitre(const Vector1& before, const Vector1& after) {
  const Vector1 sum = before + after;
  const Dual1 share = 1.0 + before.dot(after);
  return sum / share;
}

struct MovedPoints {
  Points points;
  Points rates;
  void add(const Vector1& point) {
    points.push_back(value_of(point));
    rates.push_back(rate_of(point));
  }
};

Drift offset_sides(const Polyline& line, const Dual1& distance,
                   const Polyline* rate) {
  const std::size_t n = line.corners.size();
  const std::vector<Vector1> corners =
      moving(line.corners, rate != nullptr ? &rate->corners : nullptr);
  // The mean plane is that of the corners and of what arcs go through.
  std::vector<Vector1> around;
  std::vector<std::optional<Vector1>> via(n);
  for (std::size_t k = 0; k < n; ++k) {
    around.push_back(corners[k]);
    if (line.via[k]) {
      via[k] = moving(*line.via[k],
                      rate != nullptr ? *rate->via[k] : Vec3(Vec3::Zero()));
      around.push_back(*via[k]);
    }
  }
  // Outward directions in the mean plane at both ends of each side: of a
  // straight side one, of an arc across its tangents there.
  const Vector1 normal = plane_normal(around);
  std::vector<Vector1> out_at_start(n);
  std::vector<Vector1> out_at_end(n);
  std::vector<std::optional<Vec3>> via_points(n);
  std::vector<std::optional<Vec3>> via_rates(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vector1& next = corners[(k + 1) % n];
    if (!via[k]) {
      out_at_start[k] = outward(next - corners[k], normal);
      out_at_end[k] = out_at_start[k];
      continue;
    }
    const Arc<Dual1> arc = arc_through<Dual1>(corners[k], *via[k], next);
    const Vector1 turn = arc.u.cross(arc.v);
    out_at_start[k] = outward(arc.v, normal);
    out_at_end[k] = outward(turn.cross(next - arc.center), normal);
    // The arc's own point moves by the distance across its tangent.
    const Vector1 out = outward(turn.cross(*via[k] - arc.center), normal);
    const Vector1 moved = *via[k] + distance * out;
    via_points[k] = value_of(moved);
    via_rates[k] = rate_of(moved);
  }
  // Corners move by d (n1 + n2) / (1 + n1 . n2), where the offset sides meet.
  // All of it runs over duals, so rates come along.
  MovedPoints result;
  for (std::size_t k = 0; k < n; ++k) {
    const Vector1 way = mitre(out_at_end[(k + n - 1) % n], out_at_start[k]);
    result.add(corners[k] + distance * way);
  }
  return {Polyline{std::move(result.points), std::move(via_points)},
          Polyline{std::move(result.rates), std::move(via_rates)}};
}

Drift offset(const Polygon& polygon, const Dual1& distance,
             const Polygon* rate) {
  const std::vector<std::optional<Vec3>> straight(polygon.points.size());
  Polyline moved;
  if (rate != nullptr) {
    moved = {rate->points, straight};
  }
  const Drift sides = offset_sides({polygon.points, straight}, distance,
                                   rate != nullptr ? &moved : nullptr);
  return {Polygon{std::get<Polyline>(sides.shape).corners},
          Polygon{std::get<Polyline>(sides.rate).corners}};
}

Drift offset(const Polyline& line, const Dual1& distance,
             const Polyline* rate) {
  return offset_sides(line, distance, rate);
}

Drift offset(const Spline& spline, const Dual1& distance, const Spline* rate) {
  const std::vector<Vector1> points =
      moving(spline.points, rate != nullptr ? &rate->points : nullptr);
  const Vector1 normal = plane_normal(points);
  const SplineCurve<Dual1> curve(points);
  MovedPoints result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector1 out = outward(curve.slope(static_cast<int>(k)), normal);
    result.add(points[k] + distance * out);
  }
  return {Spline{result.points}, Spline{result.rates}};
}

Drift offset(const Ellipse& e, const Dual1& distance, const Ellipse* rate) {
  const Ellipse still{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.0, 0.0};
  const Ellipse& r = rate != nullptr ? *rate : still;
  const Frame<Dual1> frame =
      frame_of<Dual1>(moving(e.normal, r.normal), moving(e.axis, r.axis));
  const Vector1 center = moving(e.center, r.center);
  const Vector1 a = moving(e.radius_1, r.radius_1) * frame.u;
  const Vector1 b = moving(e.radius_2, r.radius_2) * frame.v;
  const Vector1 normal = frame.u.cross(frame.v);
  MovedPoints result;
  for (int k = 0; k < kEllipsePoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kEllipsePoints;
    const Dual1 c = std::cos(angle);
    const Dual1 s = std::sin(angle);
    const Vector1 along = c * b - s * a;
    result.add(center + c * a + s * b + distance * outward(along, normal));
  }
  return {Spline{result.points}, Spline{result.rates}};
}

Drift offset(const Circle& circle, const Dual1& distance, const Circle* rate) {
  Drift result{circle, rate != nullptr
                           ? *rate
                           : Circle{Vec3::Zero(), Vec3::Zero(), 0.0}};
  std::get<Circle>(result.shape).radius += distance.value;
  std::get<Circle>(result.rate).radius += distance.gradient[0];
  return result;
}

void widen(Rectangle& r, double distance, bool round) {
  r.width += 2.0 * distance;
  r.height += 2.0 * distance;
  r.corner_radius += round ? distance : 0.0;
}

Drift offset(const Rectangle& r, const Dual1& distance, const Rectangle* rate) {
  const Rectangle still{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                        0.0,          0.0,          0.0};
  Rectangle shape = r;
  Rectangle moved = rate != nullptr ? *rate : still;
  widen(shape, distance.value, r.corner_radius > 0.0);
  widen(moved, distance.gradient[0], r.corner_radius > 0.0);
  return {shape, moved};
}

Drift offset(const ParametricCurve& /*curve*/, const Dual1& /*distance*/,
             const ParametricCurve* /*rate*/) {
  throw InvalidInput("a parametric curve has no offset");
}

Drift offset(const CurveCopy& /*curve*/, const Dual1& /*distance*/,
             const CurveCopy* /*rate*/) {
  throw InvalidInput(
      "a copy has no offset; offset the curve that it is a copy of");
}

/// Scaled, mirrored, turned and moved.
template <class Scalar>
struct Motion {
  Vector<Scalar> scale, axis, about, move, mirror;
  Scalar angle;
  bool mirrors = false;

  Vector<Scalar> of(const Vector<Scalar>& place) const {
    using std::cos;
    using std::sin;
    Vector<Scalar> x = place - about;
    x = Vector<Scalar>(scale.cwiseProduct(x));
    if (mirrors) {
      const Vector<Scalar> n = unit<Scalar>(mirror);
      const Scalar twice = 2.0 * n.dot(x);
      x = Vector<Scalar>(x - twice * n);
    }
    const Vector<Scalar> k = unit<Scalar>(axis);
    const Scalar c = cos(angle);
    const Scalar s = sin(angle);
    const Scalar along = k.dot(x) * (1.0 - c);
    const Vector<Scalar> turned = c * x + s * k.cross(x) + along * k;
    return turned + about + move;
  }
};

Motion<double> motion_of(const CurveCopy& c) {
  return {c.scale,
          c.axis,
          c.about,
          c.move,
          c.mirror.value_or(Vec3::UnitZ()),
          c.angle,
          c.mirror.has_value()};
}

Motion<Dual1> motion_of(const CurveCopy& c, const CurveCopy& rate) {
  return {moving(c.scale, rate.scale),
          moving(c.axis, rate.axis),
          moving(c.about, rate.about),
          moving(c.move, rate.move),
          moving(c.mirror.value_or(Vec3::UnitZ()),
                 rate.mirror.value_or(Vec3::Zero())),
          moving(c.angle, rate.angle),
          c.mirror.has_value()};
}

}  // namespace

Drift offset_of(const CurveShape& shape, double distance,
                const CurveShape* rate, double distance_rate) {
  const Dual1 out = moving(distance, distance_rate);
  return std::visit(
      [&](const auto& s) {
        using Shape = std::decay_t<decltype(s)>;
        return offset(s, out,
                      rate != nullptr ? &std::get<Shape>(*rate) : nullptr);
      },
      shape);
}

CurveShape base_of(const CurveCopy& copy) {
  return copy.offset ? offset_of(copy.of->shape, *copy.offset).shape
                     : copy.of->shape;
}

Points points_on(const CurveCopy& copy, const std::vector<double>& t) {
  Points points = points_at(base_of(copy), t);
  const Motion<double> motion = motion_of(copy);
  for (Vec3& p : points) {
    p = motion.of(p);
  }
  return points;
}

Points rates_on(const CurveCopy& copy, const CurveCopy& rate,
                const std::vector<double>& t) {
  Drift base{copy.of->shape, rate.of->shape};
  if (base.shape.index() != base.rate.index()) {
    throw InvalidInput("the rates of a curve are of another kind");
  }
  if (copy.offset) {
    base = offset_of(base.shape, *copy.offset, &rate.of->shape,
                     rate.offset.value_or(0.0));
  }
  const Points points = points_at(base.shape, t);
  Points result = point_rates(base.shape, base.rate, t);
  const Motion<Dual1> motion = motion_of(copy, rate);
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = rate_of(motion.of(moving(points[k], result[k])));
  }
  return result;
}

}  // namespace meniscus::curves::curve_shape
