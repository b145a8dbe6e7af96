#include "optimize/quadratic/quadratic_program.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/standard_problems.h"

namespace meniscus::quadratic_program_test {
namespace {

using tests::vector_of;

// KKT's conditions of the answer, and no better point among random ones: what
// tells a minimiser from everything else.
TEST(QuadraticProgram, FindsTheMinimumOfRandomOnes) {
  constexpr double kRounding = 1e-6;  // 1e-7 of each variable
  std::mt19937 draw(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 300; ++round) {
    const int n = 1 + round % 7;
    const int m = round % 6;
    const auto random = [&](int rows, int columns) {
      return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(
          rows, columns, [&] { return normal(draw); }));
    };
    const Eigen::MatrixXd root = random(n, n);
    quadratic::QuadraticProgram program{
        .hessian =
            root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n),
        .slope = random(n, 1),
        .low = -VectorX::Constant(n, unit(draw)),
        .high = VectorX::Constant(n, unit(draw)),
        .rows = random(m, n),
        .limits = random(m, 1).cwiseAbs()};  // 0 keeps them all
    const auto answer = quadratic::solve_quadratic(program);
    ASSERT_TRUE(answer) << round;
    const VectorX& d = answer->step;
    EXPECT_TRUE((d.array() >= program.low.array()).all() &&
                (d.array() <= program.high.array()).all());
    const auto value = [&](const VectorX& x) {
      return program.slope.dot(x) + 0.5 * x.dot(program.hessian * x);
    };
    const double size = 1.0 + std::abs(value(d));
    if (m > 0) {
      EXPECT_LT((program.rows * d - program.limits).maxCoeff(), kRounding);
      EXPECT_GE(answer->multipliers.minCoeff(), 0.0);
      EXPECT_LT(
          std::abs(answer->multipliers.dot(program.rows * d - program.limits)),
          kRounding * (size + answer->multipliers.maxCoeff()));
    }
    const VectorX slope = program.slope + program.hessian * d +
                          program.rows.transpose() * answer->multipliers;
    for (int j = 0; j < n; ++j) {
      const bool low = d[j] <= program.low[j] + kRounding;
      const bool high = d[j] >= program.high[j] - kRounding;
      EXPECT_TRUE((low || slope[j] < 1e-6 * size) &&
                  (high || slope[j] > -1e-6 * size))
          << round << " " << j << " " << slope[j];
    }
  }
}

// A trust region shrinks by orders of magnitude: the same problem in other
// units of the variables has the same answer, rows that cannot be kept
// included.
TEST(QuadraticProgram, IsTheSameInBoxesOfAllSizes) {
  std::mt19937 draw(12);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 100; ++round) {
    const int n = 2 + round % 4;
    const int m = 1 + round % 3;
    const auto random = [&](int rows, int columns) {
      return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(
          rows, columns, [&] { return normal(draw); }));
    };
    const Eigen::MatrixXd root = random(n, n);
    const quadratic::QuadraticProgram program{
        .hessian =
            root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n),
        .slope = random(n, 1),
        .low = -VectorX::Ones(n),
        .high = VectorX::Ones(n),
        .rows = random(m, n),
        .limits = random(m, 1)};
    const auto answer = quadratic::solve_quadratic(program);
    const VectorX missed = quadratic::least_misses(program);
    for (const double size : {1e3, 1e-2, 1e-4, 1e-6}) {
      quadratic::QuadraticProgram small = program;
      small.hessian /= size * size;
      small.slope /= size;
      small.low *= size;
      small.high *= size;
      small.rows /= size;
      const auto there = quadratic::solve_quadratic(small);
      ASSERT_EQ(there.has_value(), answer.has_value()) << round << " " << size;
      if (answer) {
        // 1e-7 is nothing, however small the box.
        EXPECT_LT((there->step / size - answer->step).cwiseAbs().maxCoeff(),
                  1e-6 + 1.1e-7 / size)
            << round << " " << size;
      }
      EXPECT_LT((quadratic::least_misses(small) - missed).cwiseAbs().maxCoeff(),
                1e-6)
          << round << " " << size;
    }
    // Rows that ask for far more than the box gives are come as near as can be.
    quadratic::QuadraticProgram far = program;
    far.limits.array() -= 1e4;
    const VectorX short_of = quadratic::least_misses(far);
    EXPECT_LT((short_of + far.limits).norm(),
              program.rows.rowwise().lpNorm<1>().norm() + 1e-6);
    EXPECT_LT(short_of.norm(), far.limits.norm());
  }
}

TEST(QuadraticProgram, SaysWhatExcludesItself) {
  quadratic::QuadraticProgram program{
      .hessian = Eigen::MatrixXd::Identity(2, 2),
      .slope = vector_of({1.0, 1.0}),
      .low = vector_of({-1.0, -1.0}),
      .high = vector_of({1.0, 1.0})};
  program.rows.resize(0, 2);
  program.add(vector_of({1.0, 0.0}), -3.0);  // x <= -3
  EXPECT_FALSE(quadratic::solve_quadratic(program));
  // Missed by 2 at x = -1.
  EXPECT_NEAR(quadratic::least_misses(program)[0], 2.0, 1e-6);
  // Two that pull at one: x <= -0.6 and x >= 0.2, missed by 0.4 each.
  program.limits[0] = -0.6;
  program.add(vector_of({-1.0, 0.0}), -0.2);
  const VectorX missed = quadratic::least_misses(program);
  EXPECT_NEAR(missed[0], 0.4, 1e-6);
  EXPECT_NEAR(missed[1], 0.4, 1e-6);
}

}  // namespace
}  // namespace meniscus::quadratic_program_test
