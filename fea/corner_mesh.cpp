#include "fea/corner_mesh.h"

namespace meniscus {

namespace {

/// Coarse number of every solver's node, or -1.
std::vector<int> number_corners(const TetMesh& mesh, const NodeOrder& order,
                                CornerMesh& result) {
  std::vector<int> coarse(mesh.nodes.size(), -1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < 4; ++c) {
      coarse[order.to_solver[mesh.element(e)[c]]] = 0;
    }
  }
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    if (coarse[i] == 0) {
      coarse[i] = static_cast<int>(result.x.size());
      result.x.push_back(mesh.nodes[order.to_mesh[i]]);
      result.map.corner.push_back(static_cast<int>(i));
    }
  }
  return coarse;
}

}  // namespace

CornerMesh make_corner_mesh(const TetMesh& mesh, const NodeOrder& order) {
  CornerMesh result;
  const std::vector<int> coarse = number_corners(mesh, order, result);
  std::vector<int> elements;
  std::vector<int> region;
  elements.reserve(4 * order.element.size());
  region.reserve(order.element.size());
  std::vector<char> seen(coarse.size(), 0);
  for (const int e : order.element) {
    const auto ids = mesh.element(e);
    const std::size_t first = elements.size();
    for (int c = 0; c < 4; ++c) {
      elements.push_back(coarse[order.to_solver[ids[c]]]);
    }
    region.push_back(mesh.element_region[e]);
    for (int m = 0; m < 6; ++m) {
      const int node = order.to_solver[ids[4 + m]];
      if (seen[node] == 0) {
        seen[node] = 1;
        result.map.mid.push_back(node);
        result.map.ends.push_back({elements[first + kTetEdges[m][0]],
                                   elements[first + kTetEdges[m][1]]});
      }
    }
  }
  result.table = make_element_table(static_cast<int>(result.x.size()), 4,
                                    elements, std::move(region));
  return result;
}

}  // namespace meniscus
