#include "evolve/walls/flush_ends.h"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::walls {

namespace {

constexpr int kPlaces = 64;
constexpr double kInPlane = 1e-9;    // off it, of the curve's size
constexpr double kLeastSine = 0.34;  // 20 degrees between film and plane

bool names(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Facets that have an edge of these vertices meet the plane at an angle.
void check_angles(const WallFilms& films, const std::set<int>& vertices,
                  const std::string& curve, const Vec3& normal) {
  const SurfaceMesh& mesh = films.mesh;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Triangle& t = mesh.facets[f];
    const auto on = std::count_if(t.begin(), t.end(),
                                  [&](int v) { return vertices.count(v) > 0; });
    if (on < 2) {
      continue;
    }
    const Vec3& x = mesh.points[t[0]];
    const Vec3 across = (mesh.points[t[1]] - x).cross(mesh.points[t[2]] - x);
    if (across.normalized().cross(normal).norm() < kLeastSine) {
      throw InvalidInput(fmt::format(
          "a wall is to be flush at curve '{}', and film '{}' meets that "
          "curve's plane at less than 20 degrees at ({:.4g}, {:.4g}, {:.4g}); "
          "leave the curve out of flush, and the wall ends square to its film",
          curve, mesh.labels[mesh.facet_label[f]], x[0], x[1], x[2]));
    }
  }
}

}  // namespace

Vec3 flush_normal(const curves::Curve& curve) {
  std::vector<double> places;
  places.reserve(kPlaces);
  for (int k = 0; k < kPlaces; ++k) {
    places.push_back(static_cast<double>(k) / kPlaces);
  }
  const Points points = curves::points_at(curve.shape, places);
  const Vec3 normal = polygon_area_vector(points).normalized();
  const double size = bounding_diagonal(points);
  for (const Vec3& p : points) {
    if (!(std::abs((p - points[0]).dot(normal)) <= kInPlane * size)) {
      throw InvalidInput(fmt::format(
          "a wall is to be flush at curve '{}', which lies in no plane: "
          "({:.4g}, {:.4g}, {:.4g}) is {:.3g} off that of the others",
          curve.name, p[0], p[1], p[2], std::abs((p - points[0]).dot(normal))));
    }
  }
  return normal;
}

void add_flush_planes(const std::vector<curves::Curve>& curves,
                      const std::vector<WallSpec>& walls, WallFilms& films) {
  for (const curves::Curve& curve : curves) {
    if (std::none_of(walls.begin(), walls.end(), [&](const WallSpec& wall) {
          return names(wall.flush, curve.name);
        })) {
      continue;
    }
    std::set<int> vertices;
    for (const RimName& rim : films.names) {
      if (rim.curve == curve.name) {
        vertices.insert(rim.vertices.begin(), rim.vertices.end());
      }
    }
    const Vec3 normal = flush_normal(curve);
    check_angles(films, vertices, curve.name, normal);
    WallPlanes& planes = films.planes;
    planes.at.resize(films.mesh.points.size());
    for (const int v : vertices) {
      planes.at[v].push_back(static_cast<int>(planes.planes.size()));
    }
    planes.planes.push_back({normal, "rim:" + curve.name});
  }
}

}  // namespace meniscus::walls
