#include "evolve/start/double_edges.h"

#include <algorithm>
#include <optional>

#include "core/geometry/edge_key.h"

namespace meniscus::start {

namespace {

/// Cuts the edge of the mesh into equal pieces, and its facets with it.
void cut_edge(int from, int to, int pieces, SurfaceMesh& mesh) {
  std::vector<int> chain = {from};
  for (int k = 1; k < pieces; ++k) {
    chain.push_back(static_cast<int>(mesh.points.size()));
    const double share = static_cast<double>(k) / pieces;
    const Vec3 between =
        (1.0 - share) * mesh.points[from] + share * mesh.points[to];
    mesh.points.push_back(between);
  }
  chain.push_back(to);
  const std::size_t facets = mesh.facets.size();
  for (std::size_t f = 0; f < facets; ++f) {
    const Triangle facet = mesh.facets[f];
    for (int k = 0; k < 3; ++k) {
      const int a = facet[k];
      const int b = facet[(k + 1) % 3];
      const int c = facet[(k + 2) % 3];
      if (edge_key(a, b) != edge_key(from, to)) {
        continue;
      }
      std::vector<int> along = chain;
      if (a != from) {
        std::reverse(along.begin(), along.end());
      }
      mesh.facets[f] = {along[0], along[1], c};
      for (std::size_t p = 1; p + 1 < along.size(); ++p) {
        mesh.facets.push_back({along[p], along[p + 1], c});
      }
    }
  }
}

/// Edges that two facets share.
std::vector<Edge> edges_across(const SurfaceMesh& mesh) {
  std::set<Edge> once;
  std::vector<Edge> across;
  for (const Triangle& facet : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      const Edge edge = edge_key(facet[k], facet[(k + 1) % 3]);
      if (!once.insert(edge).second) {
        across.push_back(edge);
      }
    }
  }
  std::sort(across.begin(), across.end());
  return across;
}

/// The first edge that there is twice, and its vertices' ids; all before it
/// are noted.
std::optional<Edge> double_edge(const SurfaceMesh& mesh,
                                const std::vector<int>& ids,
                                std::set<Edge>& taken) {
  // New points are of this face alone: any numbers that nobody has.
  const auto id_of = [&](int k) {
    const auto rim = static_cast<int>(ids.size());
    return k < rim ? ids[k] : rim - 1 - k;
  };
  for (const auto& [a, b] : edges_across(mesh)) {
    if (id_of(a) == id_of(b) ||
        !taken.insert(edge_key(id_of(a), id_of(b))).second) {
      return Edge{a, b};
    }
  }
  return std::nullopt;
}

}  // namespace

void cut_doubles(const std::vector<int>& ids, std::set<Edge>& taken,
                 SurfaceMesh& filling) {
  constexpr int kMostCuts = 1000;  // a few about a tip
  for (int cut = 0; cut < kMostCuts; ++cut) {
    std::set<Edge> now = taken;
    const std::optional<Edge> edge = double_edge(filling, ids, now);
    if (!edge) {
      for (const Edge& key : now) {
        if (key[0] >= 0) {
          taken.insert(key);
        }
      }
      return;
    }
    const auto [a, b] = *edge;
    const auto rim = static_cast<int>(ids.size());
    const bool back = a < rim && b < rim && ids[a] == ids[b];
    cut_edge(a, b, back ? 3 : 2, filling);
  }
}

}  // namespace meniscus::start
