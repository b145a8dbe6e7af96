#include "fea/shell/shell_assembly.h"

#include <algorithm>

#include "core/parallel_for.h"

namespace meniscus::shell {

namespace {

/// Facets whose matrices are held at once.
constexpr int kBatch = 1024;

}  // namespace

ShellAssembly::ShellAssembly(const ShellMesh& mesh, const ShellFreedom& freedom)
    : mesh_(mesh), freedom_(freedom) {
  const NodeFacets list = node_facets(mesh);
  const int nodes = static_cast<int>(mesh.nodes.size());
  start_.assign(1, 0);
  std::vector<int> rows;
  for (int j = 0; j < nodes; ++j) {
    rows.assign(1, j);
    for (int k = list.start[j]; k < list.start[j + 1]; ++k) {
      for (const int i : mesh.facets[list.facet[k]]) {
        if (i >= j) {
          rows.push_back(i);
        }
      }
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    int place = 0;
    for (const int i : rows) {
      row_.push_back(i);
      place_.push_back(place);
      place += freedom.free_count(i);
    }
    start_.push_back(static_cast<int>(row_.size()));
  }
}

SparseMatrix ShellAssembly::sum(const MatrixOfFacet& matrix) const {
  const int n = freedom_.unknowns();
  const int nodes = freedom_.seats();
  SparseMatrix A(n, n);
  int* outer = A.outerIndexPtr();
  outer[0] = 0;
  for (int j = 0; j < nodes; ++j) {
    const int last = start_[j + 1] - 1;
    const int height = place_[last] + freedom_.free_count(row_[last]);
    for (int c = 0; c < freedom_.free_count(j); ++c) {
      const int column = freedom_.first_unknown(j) + c;
      outer[column + 1] = outer[column] + height;
    }
  }
  A.resizeNonZeros(outer[n]);
  for (int j = 0; j < nodes; ++j) {
    for (int c = 0; c < freedom_.free_count(j); ++c) {
      int at = outer[freedom_.first_unknown(j) + c];
      for (int b = start_[j]; b < start_[j + 1]; ++b) {
        for (int r = 0; r < freedom_.free_count(row_[b]); ++r) {
          A.innerIndexPtr()[at++] = freedom_.first_unknown(row_[b]) + r;
        }
      }
    }
  }
  std::fill(A.valuePtr(), A.valuePtr() + outer[n], 0.0);
  const int facets = static_cast<int>(mesh_.facets.size());
  std::vector<FacetMatrix> batch(std::min(kBatch, facets));
  for (int first = 0; first < facets; first += kBatch) {
    const int count = std::min(kBatch, facets - first);
    parallel_for(count, [&](std::ptrdiff_t k) {
      batch[k] = matrix(first + static_cast<int>(k));
    });
    for (int k = 0; k < count; ++k) {
      add(first + k, batch[k], A);
    }
  }
  return A;
}

void ShellAssembly::add(int facet, const FacetMatrix& K,
                        SparseMatrix& sum) const {
  const auto& nodes = mesh_.facets[facet];
  for (int b = 0; b < kNodes; ++b) {
    const int j = nodes[b];
    const int columns = freedom_.free_count(j);
    for (int a = 0; a < kNodes; ++a) {
      const int i = nodes[a];
      if (i < j) {
        continue;
      }
      const auto at = std::lower_bound(row_.begin() + start_[j],
                                       row_.begin() + start_[j + 1], i);
      const int place = place_[at - row_.begin()];
      Eigen::Matrix<double, 6, 6> block = K.block<6, 6>(6 * a, 6 * b);
      const int rows = freedom_.free_count(i);
      if (!freedom_.is_plain(i)) {
        block.topRows(rows) = (freedom_.basis(i).transpose() * block).eval();
      }
      if (!freedom_.is_plain(j)) {
        block.leftCols(columns) = (block * freedom_.basis(j)).eval();
      }
      for (int c = 0; c < columns; ++c) {
        double* value = sum.valuePtr() +
                        sum.outerIndexPtr()[freedom_.first_unknown(j) + c] +
                        place;
        for (int r = 0; r < rows; ++r) {
          value[r] += block(r, c);
        }
      }
    }
  }
}

std::vector<int> ShellAssembly::elimination_order(int last_nodes) const {
  const int nodes = freedom_.seats() - last_nodes;
  SparseMatrix graph(nodes, nodes);
  for (int j = 0; j < nodes; ++j) {
    graph.startVec(j);
    for (int k = start_[j]; k < start_[j + 1] && row_[k] < nodes; ++k) {
      graph.insertBack(row_[k], j) = 1.0;
    }
  }
  graph.finalize();
  std::vector<int> order;
  order.reserve(freedom_.unknowns());
  const auto add = [&](int node) {
    for (int k = 0; k < freedom_.free_count(node); ++k) {
      order.push_back(freedom_.first_unknown(node) + k);
    }
  };
  for (const int node : nested_dissection(graph)) {
    add(node);
  }
  for (int node = nodes; node < freedom_.seats(); ++node) {
    add(node);
  }
  return order;
}

}  // namespace meniscus::shell
