/// Symmetric sparse matrices of 3 x 3 blocks, one block row per node. Only the
/// diagonal and the blocks below it are stored: products and Gauss-Seidel
/// sweeps are bound by memory traffic, and half the matrix is half of it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/types.h"
#include "fea/solver/row_chunks.h"

namespace meniscus::solver {

/// Where the blocks are. Row i holds the columns column[start[i]] ..
/// column[start[i + 1] - 1], ascending, all below i.
struct BlockPattern {
  int nodes = 0;
  std::vector<int> start;   // nodes + 1
  std::vector<int> column;  // block columns
  RowChunks chunks;         // of the rows

  /// For element e and pair k of its nodes (see assembly.h): the block.
  int nodes_per_element = 0;
  std::vector<int> element_nodes;  // ascending within an element
  std::vector<int> pair_block;     // pairs_per_element() an element

  int pairs_per_element() const {
    return nodes_per_element * (nodes_per_element - 1) / 2;
  }
  int element_count() const {
    return static_cast<int>(element_nodes.size()) / nodes_per_element;
  }
};

/// The pattern of a mesh. `element_nodes`: ids below `nodes`, ascending within
/// each element. Pair k = a (a - 1) / 2 + b, b < a, is row a, column b.
BlockPattern make_pattern(RowChunks chunks, int nodes_per_element,
                          std::vector<int> element_nodes);

/// Values: blocks row by row, B x B numbers each, row-major; `lower` ends with
/// kBlockPadding zeros more (block_kernels.h).
template <class Real>
struct BlockMatrix {
  std::vector<Real> diagonal;  // one block a node
  std::vector<Real> lower;     // one block a column of the pattern
};

/// y = A x for K vectors of padded layout: component c of node n and column k
/// stands at (n K + k) kLanes<B> + c. The padding of x must be zero, that of y
/// becomes garbage. `diagonal`, `lower`: as in BlockMatrix.
template <int B, int K, class Real>
void multiply(const BlockPattern& pattern, const Real* diagonal,
              const Real* lower, const Real* x, Real* y);

template <int B, int K>
void multiply(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
              const double* x, double* y) {
  multiply<B, K>(pattern, matrix.diagonal.data(), matrix.lower.data(), x, y);
}

/// The diagonal's entries, 3 per node.
VectorX diagonal_of(const BlockMatrix<double>& matrix);

}  // namespace meniscus::solver
