#include "core/geometry/outlier.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meniscus {

namespace {

constexpr std::size_t kFewest = 8;
constexpr double kFar = 1000.0;
constexpr double kMost = 0.9;  // share of the points that is usual

/// The value that a share of all values does not exceed.
double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(
      share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::optional<Outlier> find_outlier(const Points& points) {
  if (points.size() < kFewest) {
    return std::nullopt;
  }
  Vec3 middle;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Vec3& p) { return p[axis]; });
    middle[axis] = quantile(values, 0.5);
  }
  // Norms that neither overflow nor vanish.
  std::transform(points.begin(), points.end(), values.begin(),
                 [&](const Vec3& p) {
                   const Vec3 off = p - middle;
                   return std::hypot(off.x(), off.y(), off.z());
                 });
  const auto far = std::max_element(values.begin(), values.end());
  const double usual = quantile(values, kMost);
  if (!(*far > kFar * usual) || !(usual > 0.0)) {
    return std::nullopt;
  }
  return Outlier{static_cast<int>(far - values.begin()), *far, usual};
}

std::string outlier_text(const Outlier& outlier, const Points& points) {
  const Vec3& p = points[static_cast<std::size_t>(outlier.point)];
  return fmt::format(
      "the point ({:.6g}, {:.6g}, {:.6g}) is {:.3g} away from the middle of "
      "all points, and nine tenths of them are within {:.3g}; a number of it "
      "is wrong",
      p.x(), p.y(), p.z(), outlier.distance, outlier.usual);
}

}  // namespace meniscus
