#include "core/surface_mesh.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include <Eigen/Geometry>

namespace meniscus {

int SurfaceMesh::label_of(const std::string& name) const {
  const auto found = std::find(labels.begin(), labels.end(), name);
  return found == labels.end() ? -1 : static_cast<int>(found - labels.begin());
}

Vec3 area_vector2(const SurfaceMesh& mesh, int facet) {
  const Triangle& t = mesh.facets[facet];
  const Vec3& a = mesh.points[t[0]];
  return (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
}

double surface_area(const SurfaceMesh& mesh, int label) {
  double sum = 0.0;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    if (label < 0 || mesh.facet_label[f] == label) {
      sum += area_vector2(mesh, f).norm();
    }
  }
  return 0.5 * sum;
}

double enclosed_volume(const SurfaceMesh& mesh) {
  if (mesh.points.empty()) {
    return 0.0;
  }
  const Vec3 origin = mesh.points.front();  // keeps the terms small
  double sum = 0.0;
  for (const Triangle& t : mesh.facets) {
    const Vec3 a = mesh.points[t[0]] - origin;
    const Vec3 b = mesh.points[t[1]] - origin;
    const Vec3 c = mesh.points[t[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

void list_edges(const std::vector<Triangle>& facets, std::vector<Edge>& edges,
                std::vector<Triangle>& facet_edges) {
  edges.clear();
  facet_edges.assign(facets.size(), Triangle{});
  std::unordered_map<std::uint64_t, int> ids;
  ids.reserve(2 * facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = facets[f][k];
      const int b = facets[f][(k + 1) % 3];
      const Edge edge{std::min(a, b), std::max(a, b)};
      const std::uint64_t key = (static_cast<std::uint64_t>(edge[0]) << 32) |
                                static_cast<std::uint32_t>(edge[1]);
      const auto [at, added] = ids.emplace(key, static_cast<int>(edges.size()));
      if (added) {
        edges.push_back(edge);
      }
      facet_edges[f][k] = at->second;
    }
  }
}

double mean_edge_length(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  double sum = 0.0;
  for (const Edge& e : edges) {
    sum += (mesh.points[e[1]] - mesh.points[e[0]]).norm();
  }
  return edges.empty() ? 0.0 : sum / static_cast<double>(edges.size());
}

double bounding_diagonal(const Points& points) {
  if (points.empty()) {
    return 0.0;
  }
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace meniscus
