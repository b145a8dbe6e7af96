#include "core/math/partial_cholesky.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "core/math/linear_solve.h"

namespace meniscus::partial_cholesky_test {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr double kRounding = 1e-11;

Matrix definite(int n) {
  const Matrix half = Matrix::Random(n, n);
  return half * half.transpose() + 0.1 * n * Matrix::Identity(n, n);
}

/// A_22 - A_21 A_11^-1 A_12.
Matrix schur(const Matrix& A, int count) {
  const auto left = A.rows() - count;
  return A.bottomRightCorner(left, left) -
         A.bottomLeftCorner(left, count) *
             A.topLeftCorner(count, count)
                 .ldlt()
                 .solve(A.topRightCorner(count, left));
}

TEST(EliminateLeading, LeavesTheSchurComplement) {
  for (const int n : {1, 7, 200, 640}) {  // panels and tiles, whole and cut
    const Matrix A = definite(n);
    for (const int count : {0, 1, n / 3, n - 1, n}) {
      const auto left = n - count;
      Matrix L = A.leftCols(count);
      Matrix rest = A.bottomRightCorner(left, left);
      ASSERT_TRUE(eliminate_leading(L, rest));
      const Matrix found = rest.selfadjointView<Eigen::Lower>();
      EXPECT_LT((found - schur(A, count)).norm(), kRounding * A.norm());
      Matrix b = Matrix::Random(n, 2);
      const Matrix right = b;
      solve_leading_lower(L, b);
      if (left > 0) {
        b.bottomRows(left) =
            schur(A, count).ldlt().solve(b.bottomRows(left)).eval();
      }
      solve_leading_upper(L, b);
      EXPECT_LT((A * b - right).norm(), kRounding * A.norm() * b.norm());
    }
  }
  for (const int count : {250, 251}) {
    Matrix bad = Matrix::Identity(300, 300);
    bad(250, 250) = -1.0;
    Matrix leading = bad.leftCols(count);
    Matrix rest = bad.bottomRightCorner(300 - count, 300 - count);
    EXPECT_EQ(eliminate_leading(leading, rest), count == 250);
  }
}

/// Two grids without an edge between them, of which the last unknowns touch
/// both, one, or none.
SparseMatrix two_pieces(int n, int last) {
  Matrix A = Matrix::Zero(n, n);
  const auto join = [&](int a, int b) { A(a, b) = A(b, a) = -1.0; };
  const int half = (n - last) / 2;
  for (int k = 0; k + 1 < n - last; ++k) {
    if (k + 1 != half) {
      join(k, k + 1);
    }
  }
  for (int k = 0; k < last; ++k) {
    if (k % 3 != 0) {
      join(n - last + k, (7 * k) % (n - last));
    }
    if (k % 3 == 1) {
      join(n - last + k, n - last + (k + 1) % last);
    }
  }
  A.diagonal().setConstant(6.0);
  return SparseMatrix(Matrix(A.triangularView<Eigen::Lower>()).sparseView());
}

TEST(SymmetricFactor, CondensesOntoItsLastUnknowns) {
  for (const int last : {0, 1, 5, 12}) {
    const int n = 80;
    const SparseMatrix sparse = two_pieces(n, last);
    const Matrix A = Matrix(sparse).selfadjointView<Eigen::Lower>();
    SparseMatrix inner = sparse.topLeftCorner(n - last, n - last);
    std::vector<int> order = nested_dissection(inner);
    for (int k = n - last; k < n; ++k) {
      order.push_back(k);
    }
    SymmetricFactor factor(sparse, FactorKind::Cholesky, order);
    ASSERT_TRUE(factor.factorize(sparse));
    EXPECT_LT((factor.schur_complement(last) - schur(A, n - last)).norm(),
              kRounding * A.norm());
    const Matrix right = Matrix::Random(n, 2);
    const Matrix x = factor.solve_leading(right, last);
    EXPECT_TRUE(x.bottomRows(last).isZero(0.0));
    const Matrix left =
        A.topLeftCorner(n - last, n - last) * x.topRows(n - last) -
        right.topRows(n - last);
    EXPECT_LT(left.norm(), kRounding * right.norm());
  }
}

}  // namespace
}  // namespace meniscus::partial_cholesky_test
