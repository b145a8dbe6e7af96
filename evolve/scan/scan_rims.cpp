#include "evolve/scan/scan_rims.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "evolve/scan/scan_parts.h"
#include "evolve/start/closed_line.h"

namespace meniscus::scan {

namespace {

constexpr double kPartOfSize = 1.0 / 40.0;  // usual radius
constexpr double kLeastEdges = 2.0;         // of it, in mean edges
constexpr std::array<int, 6> kPointCounts = {6, 8, 10, 12, 16, 24};
constexpr int kLeastPoints = 6;
constexpr int kMostPoints = 200;

void check(const ScanRimOptions& options) {
  if (!(options.angle > 0.0 && options.angle < 180.0)) {
    throw InvalidInput(
        fmt::format("the angle of rims is {:g} degrees; it must be above 0 and "
                    "below 180, 25 is usual",
                    options.angle));
  }
  if (options.radius && !(*options.radius > 0.0)) {
    throw InvalidInput(fmt::format(
        "the radius of rims is {:g}; it must be above 0", *options.radius));
  }
  if (options.points &&
      (*options.points < kLeastPoints || *options.points > kMostPoints)) {
    throw InvalidInput(fmt::format("{} points a rim; expected {} to {}",
                                   *options.points, kLeastPoints, kMostPoints));
  }
}

ScanRim rim_along(const start::ClosedLine& line, const ScanRimOptions& options,
                  double within) {
  ScanRim rim;
  const auto take = [&](int count) {
    rim.points = line.smoothed(count);
    rim.deviation = line.deviation(rim.points);
  };
  if (options.points) {
    take(*options.points);
  } else {
    for (const int count : kPointCounts) {
      take(count);
      if (rim.deviation <= within) {
        break;
      }
    }
  }
  const start::MeanPlane plane = start::mean_plane(rim.points);
  rim.center = plane.center;
  rim.normal = plane.normal;
  rim.off_plane = plane.off;
  for (const Vec3& p : rim.points) {
    rim.radius +=
        (p - rim.center).norm() / static_cast<double>(rim.points.size());
  }
  rim.length = line.length();
  return rim;
}

}  // namespace

ScanRimReport find_rims(const SurfaceMesh& scan,
                        const ScanRimOptions& options) {
  check(options);
  const double edge = mean_edge_length(scan);
  ScanRimReport report;
  report.radius = options.radius.value_or(std::max(
      kPartOfSize * bounding_diagonal(scan.points), kLeastEdges * edge));
  const ScanParts parts(scan, report.radius);
  const std::vector<int> part =
      parts.merged(options.angle * std::numbers::pi / 180.0);
  report.parts =
      static_cast<int>(std::set<int>(part.begin(), part.end()).size());
  for (const PartBorder& border : parts.borders(part)) {
    const start::ClosedLine line(border.points);
    if (line.length() < 2.0 * std::numbers::pi * report.radius) {
      continue;
    }
    ScanRim rim = rim_along(line, options, edge);
    rim.turn = border.turn * 180.0 / std::numbers::pi;
    report.rims.push_back(std::move(rim));
  }
  std::stable_sort(
      report.rims.begin(), report.rims.end(),
      [](const ScanRim& a, const ScanRim& b) { return a.turn > b.turn; });
  return report;
}

}  // namespace meniscus::scan
