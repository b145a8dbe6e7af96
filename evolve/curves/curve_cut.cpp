#include "evolve/curves/curve_cut.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/surface_mesh.h"
#include "evolve/curves/curve_place.h"

namespace meniscus::curves {

namespace {

constexpr int kPieces = 64;         // between which crossings are looked for
constexpr int kPlaces = 96;         // where a curve is compared with its image
constexpr int kHalvings = 60;       // until a parameter is exact
constexpr double kInPlane = 1e-12;  // of the curve's size
constexpr double kCorner = 5e-10;   // the same, of corners: half of what an
                                    // image may be off
constexpr double kNextTo = 0.35;    // of a piece

double wrapped(double t) {
  const double result = t - std::floor(t);
  return result < 1.0 ? result : 0.0;
}

bool is_corner(const std::vector<double>& corners, double t) {
  constexpr double kSame = 1e-12;
  return std::any_of(corners.begin(), corners.end(), [&](double corner) {
    return std::abs(corner - t) < kSame;
  });
}

}  // namespace

std::vector<double> crossings(const CurveShape& shape, const Vec3& at,
                              const Vec3& normal) {
  const std::vector<double> t =
      sample_parameters(shape, length_of(shape) / kPieces);
  const Points points = points_at(shape, t);
  const double size = bounding_diagonal(points);
  const std::vector<double> corners = corner_parameters(shape);
  const std::size_t n = t.size();
  std::vector<int> side;
  for (std::size_t k = 0; k < n; ++k) {
    const double off = normal.dot(points[k] - at);
    const double zero = (is_corner(corners, t[k]) ? kCorner : kInPlane) * size;
    side.push_back(std::abs(off) <= zero ? 0 : (off > 0.0 ? 1 : -1));
  }
  std::vector<double> result;
  for (std::size_t k = 0; k < n; ++k) {
    const int here = side[k];
    const int next = side[(k + 1) % n];
    if (here == 0 && side[(k + n - 1) % n] * next < 0) {
      result.push_back(t[k]);
    }
    if (here * next >= 0) {
      continue;
    }
    double low = t[k];
    double high = k + 1 < n ? t[k + 1] : t[0] + 1.0;
    for (int step = 0; step < kHalvings; ++step) {
      const double middle = 0.5 * (low + high);
      const double off =
          normal.dot(point_at(shape, wrapped(middle)) - at) * here;
      (off > 0.0 ? low : high) = middle;
    }
    result.push_back(wrapped(0.5 * (low + high)));
  }
  std::sort(result.begin(), result.end());
  return result;
}

double asymmetry(const CurveShape& shape, const Vec3& at, const Vec3& normal,
                 double t) {
  std::vector<double> steps = corner_parameters(shape);
  for (double& step : steps) {
    step -= t;
  }
  for (int k = 0; k < kPlaces; ++k) {
    steps.push_back(static_cast<double>(k) / kPlaces);
  }
  double most = 0.0;
  for (const double s : steps) {
    const Vec3 there = point_at(shape, wrapped(t + s));
    const Vec3 here = point_at(shape, wrapped(t - s));
    const Vec3 image = here - 2.0 * normal.dot(here - at) * normal;
    most = std::max(most, (there - image).norm());
  }
  return most;
}

std::vector<double> with_parameters(const CurveShape& shape,
                                    std::vector<double> samples,
                                    const std::vector<double>& wanted) {
  std::vector<double> kept = corner_parameters(shape);
  for (const double t : wanted) {
    const auto after = std::upper_bound(samples.begin(), samples.end(), t);
    const bool wraps = after == samples.begin() || after == samples.end();
    const auto b = after == samples.end() ? samples.begin() : after;
    const auto a = after == samples.begin() ? samples.end() - 1 : after - 1;
    const double piece = *b - *a + (wraps ? 1.0 : 0.0);
    const double from_a = wrapped(t - *a);
    const double to_b = wrapped(*b - t);
    const auto gives_way = [&](double distance, double sample) {
      constexpr double kSame = 1e-9;
      return distance < kSame * piece ||
             (distance < kNextTo * piece && !is_corner(kept, sample));
    };
    if (gives_way(from_a, *a)) {
      *a = t;
    } else if (gives_way(to_b, *b)) {
      *b = t;
    } else {
      samples.push_back(t);
    }
    kept.push_back(t);
    std::sort(samples.begin(), samples.end());
  }
  return samples;
}

}  // namespace meniscus::curves
