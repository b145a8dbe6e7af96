/// Cubic B-splines: basis, evaluation, curves through points.
/// Piegl, Tiller, The NURBS Book, 2nd ed., algorithms A2.1 to A2.3.
#pragma once

#include <array>
#include <vector>

#include "cad/solid/brep.h"

namespace meniscus::solid {

/// Of the smoothing by third differences, beside 1 for each point fitted.
inline constexpr double kThirdDifferenceWeight = 1e-7;

/// The four cubic basis functions that are not 0 at a parameter.
struct SplineBasis {
  int first = 0;  // number of the first of them
  std::array<double, 4> value{};
  std::array<double, 4> slope{};  // by the parameter
};
/// `x` is cut to the knots' range; at a knot the span to its right counts, but
/// at the end.
SplineBasis spline_basis(const std::vector<double>& knots, double x);

/// A place where a spline's parameter interval is cut.
struct SplineBreak {
  double at = 0.0;
  int multiplicity = 1;  // 1: two continuous derivatives there, 2: one, 3: none
};
/// Clamped knots over [0, 1] with increasing inner breaks.
std::vector<double> clamped_knots(const std::vector<SplineBreak>& inner);

Vec3 point_of(const SplineCurve& curve, double t);
Vec3 slope_of(const SplineCurve& curve, double t);
/// Run backwards: at 1 - t.
SplineCurve reversed(const SplineCurve& curve);

struct SurfaceJet {
  Vec3 point;
  Vec3 by_a;
  Vec3 by_b;
};
SurfaceJet jet_of(const SplineSurface& surface, const Vec2& at);

struct CurveFit {
  std::vector<double> knots;
  std::vector<double> at;  // parameters of the points, in [0, 1]
  Points points;
  Vec3 start = Vec3::Zero();  // where the curve begins and ends exactly
  Vec3 end = Vec3::Zero();
  // Unit vectors that the tangents there must be normal to; zero: none.
  Vec3 start_normal = Vec3::Zero();
  Vec3 end_normal = Vec3::Zero();
};
/// Least squares with fixed ends, third differences of the poles held small
/// where points are few.
SplineCurve fit_curve(const CurveFit& fit);

}  // namespace meniscus::solid
