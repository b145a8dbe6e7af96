#include "evolve/start/closed_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/math/dense.h"
#include "evolve/curves/curve.h"
#include "evolve/start/disk_fill.h"

namespace meniscus::start {

namespace {

constexpr int kSamplesPerPoint = 12;  // of a curve, to measure distances by

}  // namespace

ClosedLine::ClosedLine(Points points) : points_(std::move(points)) {
  along_ = {0.0};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec3& next = points_[(i + 1) % points_.size()];
    along_.push_back(along_.back() + (next - points_[i]).norm());
  }
}

Points ClosedLine::smoothed(int count) const {
  const int waves = (count - 1) / 2;
  // Coefficients by the trapezoid rule over the pieces of the line.
  std::vector<Vec3> cosine(static_cast<std::size_t>(waves) + 1, Vec3::Zero());
  std::vector<Vec3> sine = cosine;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double share = (along_[i + 1] - along_[i]) / length();
    const double middle =
        std::numbers::pi * (along_[i + 1] + along_[i]) / length();
    const Vec3 at = 0.5 * (points_[i] + points_[(i + 1) % points_.size()]);
    for (int k = 0; k <= waves; ++k) {
      cosine[k] += share * std::cos(k * middle) * at;
      sine[k] += share * std::sin(k * middle) * at;
    }
  }
  Points result;
  result.reserve(static_cast<std::size_t>(count));
  for (int j = 0; j < count; ++j) {
    const double angle = 2.0 * std::numbers::pi * j / count;
    Vec3 at = cosine[0];
    for (int k = 1; k <= waves; ++k) {
      at += 2.0 *
            (std::cos(k * angle) * cosine[k] + std::sin(k * angle) * sine[k]);
    }
    result.push_back(at);
  }
  return result;
}

double ClosedLine::deviation(const Points& points) const {
  const curves::CurveShape curve = curves::Spline{points};
  const int samples = kSamplesPerPoint * static_cast<int>(points.size());
  std::vector<double> t;
  t.reserve(static_cast<std::size_t>(samples));
  for (int i = 0; i < samples; ++i) {
    t.push_back(static_cast<double>(i) / samples);
  }
  const Points on_curve = curves::points_at(curve, t);
  double sum = 0.0;
  for (const Vec3& p : points_) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < on_curve.size(); ++i) {
      const Vec3& from = on_curve[i];
      const Vec3 way = on_curve[(i + 1) % on_curve.size()] - from;
      const double share =
          std::clamp(way.dot(p - from) / way.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (from + share * way - p).squaredNorm());
    }
    sum += least;
  }
  return std::sqrt(sum / static_cast<double>(points_.size()));
}

MeanPlane mean_plane(const Points& points) {
  MeanPlane plane;
  for (const Vec3& p : points) {
    plane.center += p / static_cast<double>(points.size());
  }
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : points) {
    spread += (p - plane.center) * (p - plane.center).transpose() /
              static_cast<double>(points.size());
  }
  const auto axes = symmetric_eigen(spread);
  plane.normal = axes.vectors.col(0);
  if (plane.normal.dot(polygon_area_vector(points)) < 0.0) {
    plane.normal = -plane.normal;
  }
  plane.off = std::sqrt(std::max(axes.values[0], 0.0));
  return plane;
}

}  // namespace meniscus::start
