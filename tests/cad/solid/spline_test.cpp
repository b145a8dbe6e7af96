#include "cad/solid/spline.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace meniscus::spline_test {
namespace {

const std::vector<double> kKnots =
    solid::clamped_knots({{0.2, 1}, {0.5, 2}, {0.7, 3}, {0.9, 1}});

TEST(Spline, BasisSumsToOneAndSlopesToNothing) {
  for (int k = 0; k <= 50; ++k) {
    const solid::SplineBasis basis = solid::spline_basis(kKnots, k / 50.0);
    double sum = 0.0;
    double slopes = 0.0;
    for (int r = 0; r < 4; ++r) {
      EXPECT_GE(basis.value[r], 0.0);
      sum += basis.value[r];
      slopes += basis.slope[r];
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_NEAR(slopes, 0.0, 1e-11);
  }
}

TEST(Spline, SlopesAreDifferenceQuotients) {
  constexpr double kStep = 1e-6;
  constexpr double kTolerance = 1e-6;  // rounding over step, and step^2
  solid::SplineCurve curve{kKnots, {}};
  for (std::size_t k = 0; k + 4 < kKnots.size(); ++k) {
    const double x = static_cast<double>(k);
    curve.poles.emplace_back(std::sin(x), std::cos(2.0 * x), x);
  }
  for (const double t : {0.1, 0.3, 0.55, 0.8, 0.97}) {
    const Vec3 quotient = (solid::point_of(curve, t + kStep) -
                           solid::point_of(curve, t - kStep)) /
                          (2.0 * kStep);
    EXPECT_NEAR((quotient - solid::slope_of(curve, t)).norm(), 0.0, kTolerance);
  }
}

double arc_error(int spans) {
  std::vector<solid::SplineBreak> inner;
  for (int k = 1; k < spans; ++k) {
    inner.push_back({static_cast<double>(k) / spans, 1});
  }
  const auto exact = [](double t) {
    const double angle = t * std::numbers::pi;
    return Vec3(std::cos(angle), std::sin(angle), 0.0);
  };
  solid::CurveFit fit;
  fit.knots = solid::clamped_knots(inner);
  for (int k = 0; k <= 20 * spans; ++k) {
    fit.at.push_back(k / (20.0 * spans));
    fit.points.push_back(exact(fit.at.back()));
  }
  fit.start = exact(0.0);
  fit.end = exact(1.0);
  const solid::SplineCurve curve = solid::fit_curve(fit);
  double error = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    error = std::max(
        error, (solid::point_of(curve, k / 1000.0) - exact(k / 1000.0)).norm());
  }
  return error;
}

TEST(Spline, ArcsAreMetToFourthOrder) {
  constexpr double kLeastRatio = 12.0;  // 16 as the spans shrink
  EXPECT_GT(arc_error(4) / arc_error(8), kLeastRatio);
  EXPECT_LT(arc_error(16), 1e-5);
}

TEST(Spline, EndsAreExactAndTangentsHeld) {
  solid::CurveFit fit;
  fit.knots = solid::clamped_knots({{0.5, 1}});
  fit.start = Vec3(0.0, 0.0, 0.0);
  fit.end = Vec3(3.0, 0.0, 0.0);
  for (int k = 0; k <= 10; ++k) {
    fit.at.push_back(k / 10.0);
    fit.points.emplace_back(0.3 * k, 0.1 * k, std::sin(0.3 * k));
  }
  fit.start_normal = Vec3::UnitZ();
  const solid::SplineCurve curve = solid::fit_curve(fit);
  EXPECT_EQ(solid::point_of(curve, 0.0), fit.start);
  EXPECT_EQ(solid::point_of(curve, 1.0), fit.end);
  EXPECT_NEAR(solid::slope_of(curve, 0.0).normalized()[2], 0.0, 1e-3);
}

}  // namespace
}  // namespace meniscus::spline_test
