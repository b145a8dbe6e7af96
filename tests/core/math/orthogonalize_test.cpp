#include "core/math/orthogonalize.h"

#include <omp.h>
#include <random>

#include <Eigen/Core>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace meniscus {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns,
                              std::mt19937& draw) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns,
                                      [&] { return normal(draw); });
}

Eigen::MatrixXd random_basis(Eigen::Index rows, Eigen::Index columns,
                             std::mt19937& draw) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(
      random_matrix(rows, columns, draw));
  return qr.householderQ() * Eigen::MatrixXd::Identity(rows, columns);
}

TEST(Orthogonalize, WhatIsLeftIsTheComponentAcrossTheBasis) {
  std::mt19937 draw(5);
  for (const Eigen::Index n : {40, 8192, 20001}) {
    const Eigen::MatrixXd Q = random_basis(n, 7, draw);
    // Nearly all of it in the span: one pass would leave 1e-8 of what is left.
    const VectorX across = random_matrix(n, 1, draw);
    const VectorX exact = across - Q * (Q.transpose() * across);
    const Eigen::Index count = 6;
    VectorX v = 1e8 * (Q.leftCols(count) * VectorX::LinSpaced(count, 1.0, 2.0));
    v += exact;
    const VectorX coefficients = coefficients_of(Q, count, v);
    EXPECT_LT((coefficients - Q.leftCols(count).transpose() * v).norm(), 1e-6);
    orthogonalize(Q, count, coefficients, v);
    EXPECT_LT((Q.leftCols(count).transpose() * v).norm(), 1e-14 * v.norm());
    EXPECT_LT((v - exact).norm(), 1e-7 * exact.norm());
  }
}

TEST(Orthogonalize, SameBitsForAnyNumberOfThreads) {
  std::mt19937 draw(6);
  const Eigen::MatrixXd Q = random_basis(30000, 9, draw);
  const VectorX given = random_matrix(30000, 1, draw);
  const int before = omp_get_max_threads();
  std::vector<VectorX> found;
  for (const int threads : {1, 2, 5}) {
    omp_set_num_threads(threads);
    VectorX v = given;
    orthogonalize(Q, 9, coefficients_of(Q, 9, v), v);
    found.push_back(v);
  }
  omp_set_num_threads(before);
  EXPECT_TRUE(found[0] == found[1]);
  EXPECT_TRUE(found[0] == found[2]);
}

}  // namespace
}  // namespace meniscus
