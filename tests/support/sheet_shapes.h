/// Films with two sides, made by hand from smooth maps.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/geometry/surface_mesh.h"

namespace meniscus::shapes {

struct PatchOptions {
  int rows = 8;
  int columns = 8;
  bool around = false;   // u = 1 is u = 0
  double jitter = 0.25;  // of a cell: inner vertices lie off the grid
};

/// map(u, v) over the unit square; normals along map_u x map_v.
template <typename Map>
SurfaceMesh patch(const Map& map, const PatchOptions& options,
                  const std::string& label = "web") {
  SurfaceMesh mesh;
  mesh.labels = {label};
  const int n = options.columns;
  const int m = options.rows;
  const int width = options.around ? n : n + 1;
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i < width; ++i) {
      const bool rim = j == 0 || j == m;
      const bool side = !options.around && (i == 0 || i == n);
      const double wobble = options.jitter;
      const double du = side ? 0.0 : wobble * std::sin(12.9 * i + 78.2 * j);
      const double dv = rim ? 0.0 : wobble * std::sin(39.3 * i + 11.1 * j);
      mesh.points.push_back(map((i + du) / n, (j + dv) / m));
    }
  }
  const auto id = [&](int i, int j) {
    return j * width + (options.around ? i % n : i);
  };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = id(i, j);
      const int b = id(i + 1, j);
      const int c = id(i + 1, j + 1);
      const int d = id(i, j + 1);
      if ((i + j) % 2 == 0) {
        mesh.facets.push_back({a, b, c});
        mesh.facets.push_back({a, c, d});
      } else {
        mesh.facets.push_back({a, b, d});
        mesh.facets.push_back({b, c, d});
      }
    }
  }
  mesh.facet_label.assign(mesh.facets.size(), 0);
  return mesh;
}

/// Radius cosh(z) for |z| <= half; normals outward.
inline SurfaceMesh catenoid_sheet(double half, const PatchOptions& options) {
  return patch(
      [half](double u, double v) -> Vec3 {
        const double z = half * (2.0 * v - 1.0);
        const double angle = 2.0 * std::numbers::pi * u;
        return {std::cosh(z) * std::cos(angle), std::cosh(z) * std::sin(angle),
                z};
      },
      options);
}

/// Radius and length as given; normals outward.
inline SurfaceMesh cylinder_sheet(double radius, double length,
                                  const PatchOptions& options) {
  return patch(
      [=](double u, double v) -> Vec3 {
        const double angle = 2.0 * std::numbers::pi * u;
        return {radius * std::cos(angle), radius * std::sin(angle), length * v};
      },
      options);
}

}  // namespace meniscus::shapes
