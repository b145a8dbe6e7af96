#include "fea/solver/chebyshev.h"

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace meniscus::chebyshev_test {
namespace {

// What the steps leave of an error along the eigenvalue t of M A.
double left_of(const std::vector<solver::ChebyshevStep>& steps, double t) {
  double error = 1.0;
  double d = 0.0;
  for (const solver::ChebyshevStep& step : steps) {
    d = step.keep * d + step.take * t * error;
    error -= d;
  }
  return error;
}

TEST(Chebyshev, ReducesEveryErrorOfTheIntervalAsAsked) {
  for (const double lowest : {0.02, 0.1, 0.5}) {
    for (const double reduction : {0.5, 0.1, 1e-3}) {
      const std::vector<solver::ChebyshevStep> steps =
          solver::chebyshev_steps(lowest, 1.02, reduction, 1000);
      double largest = 0.0;
      for (double t = lowest; t <= 1.02; t += 1e-4) {
        largest = std::max(largest, std::abs(left_of(steps, t)));
      }
      EXPECT_LE(largest, reduction * (1.0 + 1e-9));
      if (steps.size() == 1) {
        continue;
      }
      // One step fewer is too few.
      const std::vector<solver::ChebyshevStep> fewer = solver::chebyshev_steps(
          lowest, 1.02, reduction, static_cast<int>(steps.size()) - 1);
      EXPECT_GT(std::abs(left_of(fewer, lowest)), reduction);
    }
  }
}

// Below the interval errors shrink, too, or the preconditioner would not be
// positive.
TEST(Chebyshev, StaysPositiveBelowTheInterval) {
  const std::vector<solver::ChebyshevStep> steps =
      solver::chebyshev_steps(0.1, 1.02, 0.2, 9);
  for (double t = 1e-6; t < 0.1; t += 1e-3) {
    EXPECT_LT(left_of(steps, t), 1.0);
    EXPECT_GT(left_of(steps, t), 0.0);
  }
}

TEST(Chebyshev, OneEigenvalueTakesOneStep) {
  const std::vector<solver::ChebyshevStep> steps =
      solver::chebyshev_steps(1.0, 1.0, 0.2, 9);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NEAR(left_of(steps, 1.0), 0.0, 1e-12);
}

// As many steps of conjugate gradients as unknowns give all eigenvalues.
TEST(Chebyshev, LanczosFindsTheLowestEigenvalue) {
  constexpr int kSize = 6;
  const Eigen::VectorXd spectrum = Eigen::VectorXd::LinSpaced(kSize, 0.03, 1.0);
  Eigen::VectorXd r = Eigen::VectorXd::Ones(kSize);
  Eigen::VectorXd p = Eigen::VectorXd::Zero(kSize);
  std::vector<double> alpha;
  std::vector<double> beta;
  double last = 1.0;
  for (int k = 0; k < kSize; ++k) {
    const double rr = r.squaredNorm();
    beta.push_back(k > 0 ? rr / last : 0.0);
    last = rr;
    p = r + beta.back() * p;
    const Eigen::VectorXd q = spectrum.cwiseProduct(p);
    alpha.push_back(rr / p.dot(q));
    r -= alpha.back() * q;
  }
  EXPECT_NEAR(solver::lowest_ritz_value(alpha, beta), 0.03, 1e-8);
}

}  // namespace
}  // namespace meniscus::chebyshev_test
