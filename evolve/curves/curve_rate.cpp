// How the points of curves move when the numbers of their shapes do.
#include <type_traits>

#include <fmt/format.h>

#include "core/error.h"
#include "evolve/curves/arc_side.h"
#include "evolve/curves/curve_copy.h"
#include "evolve/curves/spline_curve.h"

namespace meniscus::curves {

namespace {

using curve_shape::Frame;
using curve_shape::InPlane;
using curve_shape::Place;
using curve_shape::Vector1;

/// A direction that changes at `rate`.
Vector1 moving_direction(const Vec3& direction, const Vec3& rate) {
  Vector1 result;
  for (int k = 0; k < 3; ++k) {
    result[k] = Dual1::variable(direction[k], 0);
    result[k].gradient[0] = rate[k];
  }
  return result;
}

Frame<double> rate_of_frame(const Frame<Dual1>& frame) {
  Frame<double> rate;
  for (int k = 0; k < 3; ++k) {
    rate.u[k] = frame.u[k].gradient[0];
    rate.v[k] = frame.v[k].gradient[0];
  }
  return rate;
}

Frame<double> frame_rate(const Circle& c, const Circle& rate) {
  return rate_of_frame(
      curve_shape::frame_of<Dual1>(moving_direction(c.normal, rate.normal),
                                   curve_shape::is_near_pole(c.normal)));
}

template <class Shape>
Frame<double> frame_rate(const Shape& s, const Shape& rate) {
  return rate_of_frame(
      curve_shape::frame_of<Dual1>(moving_direction(s.normal, rate.normal),
                                   moving_direction(s.axis, rate.axis)));
}

template <class Shape>
Points rates_of(const Shape& shape, const Shape& rate,
                const std::vector<double>& t) {
  const Frame<double> frame = curve_shape::frame_of(shape);
  const Frame<double> turn = frame_rate(shape, rate);
  Points result;
  result.reserve(t.size());
  for (const double at : t) {
    const Place place = curve_shape::place_of(shape, at);
    const InPlane now = curve_shape::in_plane(shape, shape, place);
    const InPlane more = curve_shape::in_plane(rate, shape, place);
    result.emplace_back(rate.center + more.a * frame.u + more.b * frame.v +
                        now.a * turn.u + now.b * turn.v);
  }
  return result;
}

Vec3 rate_of_frame(const Vector1& point) {
  return {point[0].gradient[0], point[1].gradient[0], point[2].gradient[0]};
}

void require_same_count(const char* what, std::size_t count,
                        std::size_t rates) {
  if (rates != count) {
    throw InvalidInput(fmt::format("a {} of {} points has rates for {} of them",
                                   what, count, rates));
  }
}

Points rates_of(const Polygon& polygon, const Polygon& rate,
                const std::vector<double>& t) {
  const std::size_t count = polygon.points.size();
  require_same_count("polygon", count, rate.points.size());
  Points result;
  result.reserve(t.size());
  for (const double at : t) {
    const Place place = curve_shape::place_of(polygon, at);
    const auto part = static_cast<std::size_t>(place.part);
    result.emplace_back((1.0 - place.s) * rate.points[part] +
                        place.s * rate.points[(part + 1) % count]);
  }
  return result;
}

Points rates_of(const Spline& spline, const Spline& rate,
                const std::vector<double>& t) {
  require_same_count("spline", spline.points.size(), rate.points.size());
  std::vector<Vector1> points;
  for (std::size_t k = 0; k < spline.points.size(); ++k) {
    points.push_back(moving_direction(spline.points[k], rate.points[k]));
  }
  const curve_shape::SplineCurve<Dual1> curve(std::move(points));
  Points result;
  result.reserve(t.size());
  for (const double at : t) {
    result.push_back(rate_of_frame(curve.at(at)));
  }
  return result;
}

Points rates_of(const Polyline& line, const Polyline& rate,
                const std::vector<double>& t) {
  const std::size_t count = line.corners.size();
  require_same_count("polyline", count, rate.corners.size());
  require_same_count("polyline", count, rate.via.size());
  Points result;
  result.reserve(t.size());
  for (const double at : t) {
    const Place place = curve_shape::place_of(line, at);
    const auto part = static_cast<std::size_t>(place.part);
    const std::size_t next = (part + 1) % count;
    if (line.via[part] && place.s > 0.0) {
      const auto arc = curve_shape::arc_through<Dual1>(
          moving_direction(line.corners[part], rate.corners[part]),
          moving_direction(*line.via[part],
                           rate.via[part].value_or(Vec3::Zero())),
          moving_direction(line.corners[next], rate.corners[next]));
      result.push_back(rate_of_frame(arc.at(place.s)));
    } else {
      result.emplace_back((1.0 - place.s) * rate.corners[part] +
                          place.s * rate.corners[next]);
    }
  }
  return result;
}

Points rates_of(const CurveCopy& copy, const CurveCopy& rate,
                const std::vector<double>& t) {
  return curve_shape::rates_on(copy, rate, t);
}

/// Its rates are a parametric curve themselves.
Points rates_of(const ParametricCurve& /*curve*/, const ParametricCurve& rate,
                const std::vector<double>& t) {
  Points result;
  result.reserve(t.size());
  for (const double at : t) {
    result.push_back(point_at(rate, at));
  }
  return result;
}

}  // namespace

Points point_rates(const CurveShape& shape, const CurveShape& rate,
                   const std::vector<double>& t) {
  return std::visit(
      [&](const auto& s) {
        const auto* r = std::get_if<std::decay_t<decltype(s)>>(&rate);
        if (r == nullptr) {
          throw InvalidInput("the rates of a curve are of another kind");
        }
        return rates_of(s, *r, t);
      },
      shape);
}

Vec3 point_rate(const CurveShape& shape, const CurveShape& rate, double t) {
  return point_rates(shape, rate, {t}).front();
}

}  // namespace meniscus::curves
