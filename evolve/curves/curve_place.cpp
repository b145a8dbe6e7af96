#include "evolve/curves/curve_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "evolve/curves/curve_shape.h"

namespace meniscus::curves {

namespace {

constexpr int kChordsOfCurve = 256;
constexpr int kSections = 60;  // each 0.62 as wide: to rounding

}  // namespace

std::vector<CurvePlace> nearest_places(const CurveShape& shape,
                                       const Points& points) {
  const std::vector<double> t =
      sample_parameters(shape, length_of(shape), kChordsOfCurve);
  const Points at = points_at(shape, t);
  const std::size_t n = at.size();
  std::vector<double> low;
  std::vector<double> high;
  for (const Vec3& p : points) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 chord = at[(k + 1) % n] - at[k];
      const double s =
          std::clamp((p - at[k]).dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      const double d = (p - at[k] - s * chord).squaredNorm();
      if (d < least) {
        least = d;
        best = k;
      }
    }
    low.push_back(t[best]);
    high.push_back(best + 1 < n ? t[best + 1] : 1.0);
  }
  return nearest_between(shape, points, std::move(low), std::move(high));
}

std::vector<CurvePlace> nearest_between(const CurveShape& shape,
                                        const Points& points,
                                        std::vector<double> low,
                                        std::vector<double> high) {
  constexpr double kGolden = 1.0 / std::numbers::phi;
  std::vector<double> x(points.size());
  std::vector<double> y(points.size());
  for (int round = 0; round < kSections; ++round) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      x[k] = high[k] - kGolden * (high[k] - low[k]);
      y[k] = low[k] + kGolden * (high[k] - low[k]);
    }
    const Points at_x = points_at(shape, x);
    const Points at_y = points_at(shape, y);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const bool left = (at_x[k] - points[k]).squaredNorm() <=
                        (at_y[k] - points[k]).squaredNorm();
      (left ? high[k] : low[k]) = left ? y[k] : x[k];
    }
  }
  const Points inside = points_at(shape, x);
  std::vector<CurvePlace> result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    result.push_back({x[k] - std::floor(x[k]), (inside[k] - points[k]).norm()});
  }
  return result;
}

std::vector<double> corner_parameters(const CurveShape& shape) {
  const int parts = curve_shape::part_count(shape);
  std::vector<double> result;
  for (int k = 0; parts > 1 && k < parts; ++k) {
    result.push_back(static_cast<double>(k) / parts);
  }
  return result;
}

}  // namespace meniscus::curves
