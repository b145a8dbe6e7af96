#include "fea/solver/block_matrix.h"

#include <algorithm>

#include "core/operation_count.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

/// Numbers of a matrix that a product asks for before it needs them.
constexpr std::ptrdiff_t kAhead = 128;

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

BlockPattern make_pattern(RowChunks chunks, int nodes_per_element,
                          std::vector<int> element_nodes) {
  const int nodes = chunks.first.back();
  BlockPattern pattern;
  pattern.nodes = nodes;
  pattern.chunks = std::move(chunks);
  pattern.nodes_per_element = nodes_per_element;
  // Symbolic assembly, row by row: the columns of row i are the lower nodes of
  // the elements around it.
  const NodeElements around = elements_of_nodes(nodes, element_nodes);
  const int pairs = pattern.pairs_per_element();
  pattern.pair_block.resize(element_nodes.size() / nodes_per_element * pairs);
  pattern.start.assign(1, 0);
  pattern.start.reserve(nodes + 1);
  std::vector<int> position(nodes, -1);
  // A position below `first` is of an earlier row: marks need no clearing.
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
    // Rising columns; then each pair of an element gets its block for good, so
    // that numeric assembly searches nothing.
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

template <int B, int K, class Real>
void multiply(const BlockPattern& pattern, const Real* diagonal,
              const Real* lower, const Real* x, Real* y) {
  constexpr std::ptrdiff_t kWidth = K * kLanes<B>;
  // Each block below the diagonal serves twice.
  count_operations(2.0 * B * B * K *
                   (pattern.nodes + 2.0 * std::ssize(pattern.column)));
  over_chunks(pattern.chunks, RowOrder::Forward, [&](int chunk) {
    for (int i = pattern.chunks.first[chunk];
         i < pattern.chunks.first[chunk + 1]; ++i) {
      const Spread<B, K, Real> xi(x + i * kWidth);
      RowSum<B, K, Real> sum;
      const int last = pattern.start[i + 1];
      const int* column = pattern.column.data();
      const Real* block =
          lower + static_cast<std::ptrdiff_t>(B * B) * pattern.start[i];
      for (int k = pattern.start[i]; k < last; ++k, block += B * B) {
        const std::ptrdiff_t at = column[k] * kWidth;
        __builtin_prefetch(block + kAhead);
        sum.add(block, x + at);
        xi.add_transposed(block, y + at);
      }
      // Only rows after i add to y_i: it has not been written before.
      Real* yi = y + i * kWidth;
      std::fill_n(yi, kWidth, Real(0));
      xi.add_transposed(diagonal + static_cast<std::ptrdiff_t>(B * B) * i,
                        yi);  // symmetric
      for (int k = 0; k < K; ++k) {
        for (int r = 0; r < B; ++r) {
          yi[k * kLanes<B> + r] += sum.component(k, r);
        }
      }
    }
  });
}

#define MENISCUS_MULTIPLY(K)                                           \
  template void multiply<3, K>(const BlockPattern&, const double*,     \
                               const double*, const double*, double*); \
  template void multiply<3, K>(const BlockPattern&, const float*,      \
                               const float*, const float*, float*);
MENISCUS_MULTIPLY(1)
MENISCUS_MULTIPLY(2)
MENISCUS_MULTIPLY(3)
MENISCUS_MULTIPLY(4)
#undef MENISCUS_MULTIPLY

VectorX diagonal_of(const BlockMatrix<double>& matrix) {
  VectorX diagonal(static_cast<Eigen::Index>(
      3 * ((matrix.diagonal.size() - kBlockPadding) / 9)));
  for (Eigen::Index k = 0; k < diagonal.size(); ++k) {
    diagonal[k] = matrix.diagonal[9 * (k / 3) + 4 * (k % 3)];
  }
  return diagonal;
}

}  // namespace meniscus::solver
