#include "fea/free_factor.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus {

namespace {

std::vector<int> free_list(const std::vector<char>& fixed) {
  std::vector<int> dof;
  for (std::size_t d = 0; d < fixed.size(); ++d) {
    if (fixed[d] == 0) {
      dof.push_back(static_cast<int>(d));
    }
  }
  return dof;
}

/// The lower triangle by columns; the pattern holds it by rows, so columns
/// fill with ascending rows when rows are visited in order.
SparseMatrix free_matrix(const BlockPattern& pattern,
                         const BlockMatrix<double>& matrix,
                         const std::vector<char>& fixed,
                         const std::vector<int>& dof) {
  std::vector<int> number(fixed.size(), -1);
  for (std::size_t k = 0; k < dof.size(); ++k) {
    number[dof[k]] = static_cast<int>(k);
  }
  const auto n = static_cast<int>(dof.size());
  SparseMatrix A(n, n);
  const auto visit = [&](const auto& entry) {
    for (int i = 0; i < pattern.nodes; ++i) {
      for (int r = 0; r < 3; ++r) {
        const int row = number[3 * i + r];
        if (row < 0) {
          continue;
        }
        for (int b = pattern.start[i]; b < pattern.start[i + 1]; ++b) {
          for (int c = 0; c < 3; ++c) {
            const int column = number[3 * pattern.column[b] + c];
            if (column >= 0) {
              entry(row, column, matrix.lower[9L * b + 3L * r + c]);
            }
          }
        }
        for (int c = 0; c <= r; ++c) {
          if (number[3 * i + c] >= 0) {
            entry(row, number[3 * i + c], matrix.diagonal[9L * i + 3L * r + c]);
          }
        }
      }
    }
  };
  int* start = A.outerIndexPtr();
  std::fill(start, start + n + 1, 0);
  visit([&](int, int column, double) { ++start[column + 1]; });
  for (int c = 0; c < n; ++c) {
    start[c + 1] += start[c];
  }
  A.resizeNonZeros(start[n]);
  std::vector<int> next(start, start + n);
  visit([&](int row, int column, double value) {
    A.innerIndexPtr()[next[column]] = row;
    A.valuePtr()[next[column]++] = value;
  });
  return A;
}

std::vector<int> elimination_order(const BlockPattern& pattern,
                                   const std::vector<char>& fixed) {
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
  std::vector<int> number(fixed.size(), -1);
  int count = 0;
  for (std::size_t d = 0; d < fixed.size(); ++d) {
    if (fixed[d] == 0) {
      number[d] = count++;
    }
  }
  std::vector<int> order;
  order.reserve(count);
  for (const int dof : expand_order(nested_dissection(graph), 3)) {
    if (number[dof] >= 0) {
      order.push_back(number[dof]);
    }
  }
  return order;
}

}  // namespace

FreeFactor::FreeFactor(const BlockPattern& pattern,
                       const BlockMatrix<double>& matrix,
                       const std::vector<char>& fixed)
    : dof_(free_list(fixed)), factor_([&] {
        const SparseMatrix A = free_matrix(pattern, matrix, fixed, dof_);
        SymmetricFactor factor(A, FactorKind::Cholesky,
                               elimination_order(pattern, fixed));
        if (!factor.factorize(A)) {
          throw SolverError(fmt::format(
              "the stiffness matrix of {} unknowns is not positive definite: a "
              "piece of the part hangs on a single node or edge and can turn, "
              "or the elements are nearly flat",
              dof_.size()));
        }
        return factor;
      }()) {}

void FreeFactor::solve(const double* r, double* z, int K) const {
  const Eigen::Index n = size();
  Eigen::MatrixXd right(n, K);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int k = 0; k < K; ++k) {
      right(i, k) = r[static_cast<std::ptrdiff_t>(dof_[i]) * K + k];
    }
  }
  const Eigen::MatrixXd x = factor_.solve(right);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int k = 0; k < K; ++k) {
      z[static_cast<std::ptrdiff_t>(dof_[i]) * K + k] = x(i, k);
    }
  }
}

}  // namespace meniscus
