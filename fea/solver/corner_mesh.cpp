#include "fea/solver/corner_mesh.h"

#include <algorithm>
#include <numeric>

namespace meniscus::solver {

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

/// The chunks of fine nodes, cut down to the corners in them.
RowChunks corner_chunks(const RowChunks& fine, const std::vector<int>& corner) {
  RowChunks chunks;
  chunks.colour = fine.colour;
  chunks.first.clear();
  for (const int row : fine.first) {
    chunks.first.push_back(static_cast<int>(
        std::lower_bound(corner.begin(), corner.end(), row) - corner.begin()));
  }
  return chunks;
}

/// The mesh's elements by their lowest coarse node.
std::vector<int> order_corner_elements(const TetMesh& mesh,
                                       const NodeOrder& order,
                                       const std::vector<int>& coarse,
                                       int corners) {
  std::vector<int> start(corners + 1, 0);
  std::vector<int> lowest(order.element.size());
  for (std::size_t k = 0; k < lowest.size(); ++k) {
    const auto ids = mesh.element(order.element[k]);
    int low = corners;
    for (int c = 0; c < 4; ++c) {
      low = std::min(low, coarse[order.to_solver[ids[c]]]);
    }
    lowest[k] = low;
    ++start[low + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> element(lowest.size());
  for (std::size_t k = 0; k < lowest.size(); ++k) {
    element[start[lowest[k]]++] = order.element[k];
  }
  return element;
}

void list_mids(CornerMap& map) {
  map.around_start.assign(map.corner.size() + 1, 0);
  for (const auto& pair : map.ends) {
    ++map.around_start[pair[0] + 1];
    ++map.around_start[pair[1] + 1];
  }
  std::partial_sum(map.around_start.begin(), map.around_start.end(),
                   map.around_start.begin());
  map.around.resize(2 * map.mid.size());
  std::vector<int> next(map.around_start.begin(), map.around_start.end() - 1);
  for (std::size_t m = 0; m < map.mid.size(); ++m) {
    for (const int end : map.ends[m]) {
      map.around[next[end]++] = map.mid[m];
    }
  }
}

}  // namespace

CornerMesh make_corner_mesh(const TetMesh& mesh, const NodeOrder& order) {
  CornerMesh result;
  const std::vector<int> coarse = number_corners(mesh, order, result);
  const int corners = static_cast<int>(result.x.size());
  result.element = order_corner_elements(mesh, order, coarse, corners);
  std::vector<int> elements;
  std::vector<int> region;
  elements.reserve(4 * result.element.size());
  region.reserve(result.element.size());
  std::vector<char> seen(coarse.size(), 0);
  for (const int e : result.element) {
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
  list_mids(result.map);
  result.table =
      make_element_table(corner_chunks(order.chunks, result.map.corner), 4,
                         elements, std::move(region));
  return result;
}

}  // namespace meniscus::solver
