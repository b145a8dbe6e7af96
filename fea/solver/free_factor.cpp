#include "fea/solver/free_factor.h"

#include <algorithm>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

/// Free directions as the first columns, and how many; the axes themselves
/// where the support follows them.
struct FreeBasis {
  Mat3 axes = Mat3::Identity();
  int rank = 3;
};

FreeBasis free_basis(const Mat3& projector) {
  FreeBasis basis;
  basis.rank = 0;
  const Mat3 diagonal = projector.diagonal().asDiagonal();
  Mat3 vectors = Mat3::Identity();
  Vec3 values = projector.diagonal();
  if (projector != diagonal) {
    const auto solver = symmetric_eigen(projector);
    vectors = solver.vectors;
    values = solver.values;
  }
  basis.axes.setZero();
  for (int k = 0; k < 3; ++k) {
    if (values[k] > 0.5) {
      basis.axes.col(basis.rank++) = vectors.col(k);
    }
  }
  return basis;
}

/// The matrix on the free directions, lower triangle by columns. The pattern
/// holds it by rows, so columns fill with ascending rows when rows are visited
/// in order.
class FreeMatrix {
 public:
  FreeMatrix(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
             const std::vector<int>& start, const std::vector<FreeBasis>& bases)
      : pattern_(pattern), matrix_(matrix), start_(start), bases_(bases) {}

  SparseMatrix build() const {
    const int n = start_.back();
    SparseMatrix A(n, n);
    int* first = A.outerIndexPtr();
    std::fill(first, first + n + 1, 0);
    visit([&](int, int column, double) { ++first[column + 1]; });
    for (int c = 0; c < n; ++c) {
      first[c + 1] += first[c];
    }
    A.resizeNonZeros(first[n]);
    std::vector<int> next(first, first + n);
    visit([&](int row, int column, double value) {
      A.innerIndexPtr()[next[column]] = row;
      A.valuePtr()[next[column]++] = value;
    });
    return A;
  }

 private:
  Mat3 turned(int i, int j, const double* block) const {
    return bases_[i].axes.transpose() * Eigen::Map<const RowMat3>(block) *
           bases_[j].axes;
  }

  template <class Entry>
  void visit(const Entry& entry) const {
    for (int i = 0; i < pattern_.nodes; ++i) {
      const int first = pattern_.start[i];
      const int count = pattern_.start[i + 1] - first;
      std::vector<Mat3> blocks;
      blocks.reserve(count + 1);
      for (int b = 0; b < count; ++b) {
        blocks.push_back(turned(i, pattern_.column[first + b],
                                matrix_.lower.data() + 9L * (first + b)));
      }
      blocks.push_back(turned(i, i, matrix_.diagonal.data() + 9L * i));
      for (int r = 0; r < bases_[i].rank; ++r) {
        for (int b = 0; b <= count; ++b) {
          const int j = b < count ? pattern_.column[first + b] : i;
          const int last = b < count ? bases_[j].rank : r + 1;
          for (int c = 0; c < last; ++c) {
            entry(start_[i] + r, start_[j] + c, blocks[b](r, c));
          }
        }
      }
    }
  }

  const BlockPattern& pattern_;
  const BlockMatrix<double>& matrix_;
  const std::vector<int>& start_;
  const std::vector<FreeBasis>& bases_;
};

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
        std::vector<FreeBasis> bases(pattern.nodes);
        for (std::size_t h = 0; h < held_.size(); ++h) {
          bases[held_[h]] = free_basis(freedom.projector[h]);
          axes_.push_back(bases[held_[h]].axes);
        }
        start_.assign(1, 0);
        for (const FreeBasis& basis : bases) {
          start_.push_back(start_.back() + basis.rank);
        }
        // A = Q^T K Q has no held unknowns left; Cholesky in the order of
        // nested dissection of the nodes (George 1973).
        const SparseMatrix A =
            FreeMatrix(pattern, matrix, start_, bases).build();
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
