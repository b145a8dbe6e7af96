#include "fea/block_matrix.h"

#include <algorithm>

#include "fea/block_kernels.h"

namespace meniscus {

namespace {

/// Elements around each node: `place` holds element * nodes_per_element +
/// local position, grouped by node.
struct NodeElements {
  std::vector<int> start;
  std::vector<int> place;
};

NodeElements elements_of_nodes(int nodes, const std::vector<int>& ids) {
  NodeElements result;
  result.start.assign(nodes + 1, 0);
  for (const int node : ids) {
    ++result.start[node + 1];
  }
  for (int i = 0; i < nodes; ++i) {
    result.start[i + 1] += result.start[i];
  }
  result.place.resize(ids.size());
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    result.place[next[ids[k]]++] = static_cast<int>(k);
  }
  return result;
}

}  // namespace

BlockPattern make_pattern(int nodes, int nodes_per_element,
                          std::vector<int> element_nodes) {
  BlockPattern pattern;
  pattern.nodes = nodes;
  pattern.nodes_per_element = nodes_per_element;
  const NodeElements around = elements_of_nodes(nodes, element_nodes);
  const int pairs = pattern.pairs_per_element();
  pattern.pair_block.resize(element_nodes.size() / nodes_per_element * pairs);
  pattern.start.assign(1, 0);
  pattern.start.reserve(nodes + 1);
  std::vector<int> position(nodes, -1);
  for (int i = 0; i < nodes; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(pattern.column.size());
    for (int k = around.start[i]; k < around.start[i + 1]; ++k) {
      // Nodes ascend within an element: those before `place` are below i.
      const int place = around.place[k];
      for (int b = place - place % nodes_per_element; b < place; ++b) {
        if (position[element_nodes[b]] < first) {
          position[element_nodes[b]] = static_cast<int>(pattern.column.size());
          pattern.column.push_back(element_nodes[b]);
        }
      }
    }
    std::sort(pattern.column.begin() + first, pattern.column.end());
    for (auto k = first; k < std::ssize(pattern.column); ++k) {
      position[pattern.column[k]] = static_cast<int>(k);
    }
    for (int k = around.start[i]; k < around.start[i + 1]; ++k) {
      const int place = around.place[k];
      const int e = place / nodes_per_element;
      const int a = place % nodes_per_element;
      for (int b = 0; b < a; ++b) {
        pattern.pair_block[static_cast<std::size_t>(e) * pairs +
                           a * (a - 1) / 2 + b] =
            position[element_nodes[place - a + b]];
      }
    }
    pattern.start.push_back(static_cast<int>(pattern.column.size()));
  }
  pattern.column.shrink_to_fit();
  pattern.element_nodes = std::move(element_nodes);
  return pattern;
}

template <int K>
void multiply(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
              const double* x, double* y) {
  constexpr int kWidth = 3 * K;
  const double* block = matrix.lower.data();
  for (int i = 0; i < pattern.nodes; ++i) {
    const double* xi = x + static_cast<std::ptrdiff_t>(i) * kWidth;
    double t[kWidth] = {};
    add_block<K>(matrix.diagonal.data() + static_cast<std::ptrdiff_t>(9) * i,
                 xi, t);
    for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k, block += 9) {
      const std::ptrdiff_t j =
          static_cast<std::ptrdiff_t>(pattern.column[k]) * kWidth;
      add_block<K>(block, x + j, t);
      add_block_transposed<K>(block, xi, y + j);
    }
    // Rows above i only are touched by the transposed blocks of this row, so
    // y_i has not been written before.
    double* yi = y + static_cast<std::ptrdiff_t>(i) * kWidth;
    for (int k = 0; k < kWidth; ++k) {
      yi[k] = t[k];
    }
  }
}

template void multiply<1>(const BlockPattern&, const BlockMatrix<double>&,
                          const double*, double*);
template void multiply<2>(const BlockPattern&, const BlockMatrix<double>&,
                          const double*, double*);
template void multiply<3>(const BlockPattern&, const BlockMatrix<double>&,
                          const double*, double*);
template void multiply<4>(const BlockPattern&, const BlockMatrix<double>&,
                          const double*, double*);

}  // namespace meniscus
