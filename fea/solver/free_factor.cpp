#include "fea/solver/free_factor.h"

#include <algorithm>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "fea/solver/block_kernels.h"
#include "fea/solver/free_matrix.h"

namespace meniscus::solver {

namespace {

std::vector<int> elimination_order(const BlockPattern& pattern,
                                   const std::vector<int>& unknown) {
  const int n = pattern.nodes;
  SparseMatrix graph(n, n);
  int* start = graph.outerIndexPtr();
  std::fill(start, start + n + 1, 0);
  for (const int column : pattern.column) {
    ++start[column + 1];
  }
  for (int c = 0; c < n; ++c) {
    start[c + 1] += start[c];
  }
  graph.resizeNonZeros(start[n]);
  std::vector<int> next(start, start + n);
  for (int i = 0; i < n; ++i) {
    for (int b = pattern.start[i]; b < pattern.start[i + 1]; ++b) {
      const int place = next[pattern.column[b]]++;
      graph.innerIndexPtr()[place] = i;
      graph.valuePtr()[place] = 1.0;
    }
  }
  std::vector<int> order;
  order.reserve(unknown.back());
  for (const int node : nested_dissection(graph)) {
    for (int u = unknown[node]; u < unknown[node + 1]; ++u) {
      order.push_back(u);
    }
  }
  return order;
}

}  // namespace

FreeFactor::FreeFactor(const BlockPattern& pattern,
                       const BlockMatrix<double>& matrix,
                       const NodeFreedom& freedom)
    : held_(freedom.held), factor_([&] {
        // An orthonormal basis Q_i of what is free at each node.
        const FreeUnknowns unknowns = free_unknowns(freedom, pattern.nodes);
        for (const int node : held_) {
          axes_.push_back(unknowns.bases[node].axes);
        }
        start_ = unknowns.start;
        // A = Q^T K Q has no held unknowns left; Cholesky in the order of
        // nested dissection of the nodes (George 1973).
        const SparseMatrix A = free_matrix(pattern, matrix, unknowns);
        SymmetricFactor factor(A, FactorKind::Cholesky,
                               elimination_order(pattern, start_));
        if (!factor.factorize(A)) {
          throw SolverError(fmt::format(
              "the stiffness matrix of {} unknowns is not positive definite: a "
              "piece of the part hangs on a single node or edge and can turn, "
              "or the elements are nearly flat",
              start_.back()));
        }
        return factor;
      }()) {}

void FreeFactor::solve(const double* r, double* z, int K) const {
  constexpr int kLane = kLanes<3>;
  const int nodes = static_cast<int>(start_.size()) - 1;
  // work(node, column, axes) for every node and column.
  const auto visit = [&](const auto& work) {
    std::size_t h = 0;
    for (int i = 0; i < nodes; ++i) {
      const bool held = h < held_.size() && held_[h] == i;
      const Mat3 axes = held ? axes_[h++] : Mat3(Mat3::Identity());
      for (int k = 0; k < K; ++k) {
        work(i, k, axes.leftCols(start_[i + 1] - start_[i]));
      }
    }
  };
  // z = Q A^-1 Q^T r: held directions drop out and come back as 0.
  Eigen::MatrixXd right(start_.back(), K);
  visit([&](int i, int k, const auto& axes) {
    right.col(k).segment(start_[i], axes.cols()) =
        axes.transpose() *
        Eigen::Map<const Vec3>(r + (static_cast<std::ptrdiff_t>(i) * K + k) *
                                       kLane);
  });
  const Eigen::MatrixXd x = factor_.solve(right);
  visit([&](int i, int k, const auto& axes) {
    Eigen::Map<Vec3>(z + (static_cast<std::ptrdiff_t>(i) * K + k) * kLane) =
        axes * x.col(k).segment(start_[i], axes.cols());
  });
}

}  // namespace meniscus::solver
