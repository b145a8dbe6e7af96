#include "tests/support/nested_surface.h"

#include <numeric>

#include "core/geometry/edge_key.h"

namespace meniscus {

NestedSurface nested_surface(const SurfaceMesh& base, int levels) {
  NestedSurface result;
  result.points = base.points;
  std::vector<Triangle> facets = base.facets;
  for (int level = 0; level < levels; ++level) {
    std::vector<Edge> edges;
    std::vector<Triangle> facet_edges;
    list_edges(facets, edges, facet_edges);
    const auto first = static_cast<int>(result.points.size());
    for (const auto& [a, b] : edges) {
      result.middles[edge_key(a, b)] = static_cast<int>(result.points.size());
      result.points.push_back(0.5 * (result.points[a] + result.points[b]));
    }
    std::vector<Triangle> finer;
    for (std::size_t f = 0; f < facets.size(); ++f) {
      const Triangle& t = facets[f];
      const Triangle m = {first + facet_edges[f][0], first + facet_edges[f][1],
                          first + facet_edges[f][2]};
      finer.insert(
          finer.end(),
          {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, m});
    }
    facets = std::move(finer);
  }
  result.straight.assign(result.points.size(), 0);
  SurfaceMesh mesh = base;
  mesh.points.clear();
  std::vector<int> corner(base.points.size());
  std::iota(corner.begin(), corner.end(), 0);
  result.nodes = surface_nodes(std::move(mesh), std::move(corner),
                               result.middles, result.straight);
  return result;
}

}  // namespace meniscus
