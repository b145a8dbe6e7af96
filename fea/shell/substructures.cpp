#include "fea/shell/substructures.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/math/linear_solve.h"
#include "fea/shell/facet_rule.h"

namespace meniscus::shell {

namespace {

constexpr int kEdges = 3;

/// All in one place, as facets within a rigid film are: nothing bends.
bool is_rigid(const std::array<int, 6>& facet) {
  return std::all_of(facet.begin(), facet.end(),
                     [&](int node) { return node == facet[0]; });
}

/// Those that bend. Such that share a middle share an edge; one list after the
/// other.
struct FacetGraph {
  std::vector<int> facets;
  std::vector<int> start;
  std::vector<int> neighbors;
};

FacetGraph facet_graph(const ShellMesh& mesh, const NodeFacets& at) {
  FacetGraph graph;
  std::vector<int> number(mesh.facets.size(), -1);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (!is_rigid(mesh.facets[f])) {
      number[f] = static_cast<int>(graph.facets.size());
      graph.facets.push_back(static_cast<int>(f));
    }
  }
  graph.start.push_back(0);
  for (const int f : graph.facets) {
    for (int k = 0; k < kEdges; ++k) {
      const int middle = mesh.facets[f][kEdges + k];
      if (middle == mesh.facets[f][k] ||
          middle == mesh.facets[f][(k + 1) % kEdges]) {
        continue;  // an edge of a rigid rim, all of which is one place
      }
      for (int i = at.start[middle]; i < at.start[middle + 1]; ++i) {
        const int other = number[at.facet[i]];
        if (other >= 0 && at.facet[i] != f) {
          graph.neighbors.push_back(other);
        }
      }
    }
    graph.start.push_back(static_cast<int>(graph.neighbors.size()));
  }
  return graph;
}

/// Per facet. A rigid one is where a facet that bends has its place.
std::vector<int> leaves_of(const ShellMesh& mesh, int levels) {
  const NodeFacets at = node_facets(mesh);
  const FacetGraph graph = facet_graph(mesh, at);
  const std::vector<int> own =
      bisected_graph(graph.start, graph.neighbors, levels);
  std::vector<int> leaf(mesh.facets.size(), 0);
  for (std::size_t k = 0; k < own.size(); ++k) {
    leaf[graph.facets[k]] = own[k];
  }
  std::vector<int> near(mesh.nodes.size(), 0);  // by place
  for (const int f : graph.facets) {
    for (const int node : mesh.facets[f]) {
      near[node] = leaf[f];
    }
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (is_rigid(mesh.facets[f])) {
      leaf[f] = near[mesh.facets[f][0]];
    }
  }
  return leaf;
}

/// The least part that both are in.
int common_part(int a, int b) {
  while (a != b) {
    (a > b ? a : b) /= 2;
  }
  return a;
}

}  // namespace

Substructures cut_shell(const ShellMesh& mesh, int levels) {
  Substructures cut;
  cut.levels = levels;
  cut.parts.resize(2UL << levels);
  cut.facets.resize(1UL << levels);
  const std::vector<int> leaf = leaves_of(mesh, levels);
  std::vector<int> home(mesh.nodes.size(), 0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    cut.facets[leaf[f]].push_back(static_cast<int>(f));
    for (const int node : mesh.facets[f]) {
      const int part = cut.part_of(leaf[f]);
      home[node] = home[node] == 0 ? part : common_part(home[node], part);
    }
  }
  // Each node is on the boundary of the parts from its leaves up to its home.
  std::vector<std::vector<int>> within(mesh.nodes.size());
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (const int node : mesh.facets[f]) {
      for (int part = cut.part_of(leaf[f]); part != home[node]; part /= 2) {
        within[node].push_back(part);
      }
    }
  }
  for (std::size_t node = 0; node < home.size(); ++node) {
    cut.parts[home[node]].own.push_back(static_cast<int>(node));
    std::sort(within[node].begin(), within[node].end());
    within[node].erase(std::unique(within[node].begin(), within[node].end()),
                       within[node].end());
    for (const int part : within[node]) {
      cut.parts[part].boundary.push_back(static_cast<int>(node));
    }
  }
  return cut;
}

}  // namespace meniscus::shell
