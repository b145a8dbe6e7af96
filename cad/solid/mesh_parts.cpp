#include "cad/solid/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include <Eigen/Geometry>

#include "core/geometry/edge_key.h"

namespace meniscus::solid {

namespace {

// [rad]: facets of one plane, some of them narrow, are known to fewer digits
// than their corners.
constexpr double kCrease = 1e-4;

}  // namespace

std::vector<std::vector<int>> connected_parts(
    const SurfaceMesh& mesh,
    const std::function<bool(int facet, int other, const Edge& edge)>& ends) {
  std::map<Edge, std::vector<int>> at_edge;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.facets[f][k];
      const int b = mesh.facets[f][(k + 1) % 3];
      at_edge[edge_key(a, b)].push_back(static_cast<int>(f));
    }
  }
  std::vector<char> seen(mesh.facets.size(), 0);
  std::vector<std::vector<int>> parts;
  for (std::size_t first = 0; first < mesh.facets.size(); ++first) {
    if (seen[first] != 0) {
      continue;
    }
    seen[first] = 1;
    std::vector<int> part;
    std::deque<int> queue{static_cast<int>(first)};
    while (!queue.empty()) {
      const int f = queue.front();
      queue.pop_front();
      part.push_back(f);
      for (int k = 0; k < 3; ++k) {
        const int a = mesh.facets[f][k];
        const int b = mesh.facets[f][(k + 1) % 3];
        for (const int g : at_edge[edge_key(a, b)]) {
          const int label = mesh.facet_label[f];
          if (seen[g] == 0 && mesh.facet_label[g] == label &&
              !ends(f, g, edge_key(a, b))) {
            seen[g] = 1;
            queue.push_back(g);
          }
        }
      }
    }
    std::sort(part.begin(), part.end());
    parts.push_back(std::move(part));
  }
  return parts;
}

double angle_between(const SurfaceMesh& mesh, int facet, int other) {
  const Vec3 a = area_vector2(mesh, facet);
  const Vec3 b = area_vector2(mesh, other);
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

bool is_crease(const SurfaceMesh& mesh, int facet, int other) {
  return angle_between(mesh, facet, other) > kCrease;
}

}  // namespace meniscus::solid
