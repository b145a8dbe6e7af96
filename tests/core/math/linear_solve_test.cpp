#include "core/math/linear_solve.h"

#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::linear_solve_test {
namespace {

constexpr double kResidual = 1e-12;  // relative, condition number about 1e3

/// Lower triangle of the five-point Laplacian on n x n points, plus `shift`.
SparseMatrix laplacian(int n, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto id = [n](int i, int j) { return j * n + i; };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      entries.emplace_back(id(i, j), id(i, j), 4.0 + shift);
      if (i + 1 < n) {
        entries.emplace_back(id(i + 1, j), id(i, j), -1.0);
      }
      if (j + 1 < n) {
        entries.emplace_back(id(i, j + 1), id(i, j), -1.0);
      }
    }
  }
  SparseMatrix matrix(n * n, n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::MatrixXd random_columns(int rows, int columns) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd matrix(rows, columns);
  for (auto& x : matrix.reshaped()) {
    x = uniform(generator);
  }
  return matrix;
}

double relative_residual(const SparseMatrix& lower, const Eigen::MatrixXd& x,
                         const Eigen::MatrixXd& b) {
  return (lower.selfadjointView<Eigen::Lower>() * x - b).norm() / b.norm();
}

TEST(SymmetricFactor, CholeskySolvesSeveralColumns) {
  const SparseMatrix a = laplacian(40, 0.0);
  SymmetricFactor factor(a, FactorKind::Cholesky);
  ASSERT_TRUE(factor.factorize(a));
  const Eigen::MatrixXd b = random_columns(1600, 3);
  EXPECT_LT(relative_residual(a, factor.solve(b), b), kResidual);
  EXPECT_GT(factor.entries(), a.nonZeros());
}

TEST(SymmetricFactor, CholeskyRefusesAnIndefiniteMatrix) {
  const SparseMatrix a = laplacian(10, -4.0);
  SymmetricFactor factor(a, FactorKind::Cholesky);
  EXPECT_FALSE(factor.factorize(a));
  EXPECT_GE(factor.failed_column(), 0);
}

TEST(SymmetricFactor, InertiaCountsNegativeEigenvalues) {
  // Eigenvalues are 4 + shift - 2 cos(i h) - 2 cos(j h), h = pi / (n + 1).
  const int n = 17;
  const double shift = -1.37;
  const double h = 3.14159265358979323846 / (n + 1);
  int expected = 0;
  for (int i = 1; i <= n; ++i) {
    for (int j = 1; j <= n; ++j) {
      expected +=
          4 + shift - 2 * std::cos(i * h) - 2 * std::cos(j * h) < 0 ? 1 : 0;
    }
  }
  const SparseMatrix a = laplacian(n, shift);
  SymmetricFactor factor(a, FactorKind::Indefinite);
  ASSERT_TRUE(factor.factorize(a));
  EXPECT_GT(expected, 0);
  EXPECT_EQ(factor.negative_pivots(), expected);
  const Eigen::MatrixXd b = random_columns(n * n, 1);
  EXPECT_LT(relative_residual(a, factor.solve(b), b), 1e3 * kResidual);
}

TEST(SymmetricFactor, RefactorsOnTheSamePatternAndRepeatsItsBits) {
  const SparseMatrix a = laplacian(30, 0.5);
  const SparseMatrix other = laplacian(30, 2.0);
  SymmetricFactor factor(a, FactorKind::Cholesky);
  const Eigen::MatrixXd b = random_columns(900, 1);
  ASSERT_TRUE(factor.factorize(a));
  const Eigen::MatrixXd first = factor.solve(b);
  ASSERT_TRUE(factor.factorize(other));
  EXPECT_LT(relative_residual(other, factor.solve(b), b), kResidual);
  ASSERT_TRUE(factor.factorize(a));
  EXPECT_TRUE(factor.solve(b) == first);
}

TEST(SymmetricFactor, SolvesFromTwoThreadsAlike) {
  const SparseMatrix a = laplacian(50, 0.0);
  SymmetricFactor factor(a, FactorKind::Cholesky);
  ASSERT_TRUE(factor.factorize(a));
  const Eigen::MatrixXd b = random_columns(2500, 2);
  Eigen::MatrixXd one;
  Eigen::MatrixXd two;
  std::thread left([&] { one = factor.solve(b); });
  std::thread right([&] { two = factor.solve(b); });
  left.join();
  right.join();
  EXPECT_TRUE(one == two);
}

TEST(SymmetricFactor, RefusesAWrongRightSide) {
  const SparseMatrix a = laplacian(5, 0.0);
  SymmetricFactor factor(a, FactorKind::Cholesky);
  ASSERT_TRUE(factor.factorize(a));
  EXPECT_THROW(factor.solve(random_columns(24, 1)), SolverError);
}

TEST(NestedDissection, IsAPermutationEvenOfUnconnectedUnknowns) {
  SparseMatrix diagonal(6, 6);
  diagonal.setIdentity();
  for (const SparseMatrix& matrix : {diagonal, laplacian(12, 0.0)}) {
    std::vector<int> order = nested_dissection(matrix);
    std::sort(order.begin(), order.end());
    for (int k = 0; k < static_cast<int>(order.size()); ++k) {
      EXPECT_EQ(order[k], k);
    }
  }
}

TEST(SymmetricFactor, OfNoUnknownsSolvesNothing) {
  SparseMatrix none(0, 0);
  none.makeCompressed();
  for (const FactorKind kind : {FactorKind::Cholesky, FactorKind::Indefinite}) {
    SymmetricFactor factor(none, kind);
    EXPECT_TRUE(factor.factorize(none));
    EXPECT_EQ(factor.solve(Eigen::MatrixXd(0, 3)).cols(), 3);
    EXPECT_EQ(factor.entries(), 0);
    EXPECT_EQ(factor.negative_pivots(), 0);
  }
}

}  // namespace
}  // namespace meniscus::linear_solve_test
