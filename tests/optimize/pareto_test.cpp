#include "optimize/pareto.h"

#include <cmath>

#include <gmock/gmock.h>

#include "optimize/samples/sampling.h"
#include "optimize/samples/spread.h"
#include "tests/support/standard_problems.h"

namespace meniscus::pareto_test {
namespace {

using testing::ElementsAre;
using tests::vector_of;

TEST(ParetoFront, KeepsWhatNothingBeats) {
  EXPECT_THAT(
      optimize::pareto_front({vector_of({1.0, 5.0}), vector_of({2.0, 2.0}),
                              vector_of({3.0, 3.0}), vector_of({2.0, 2.0}),
                              vector_of({4.0, 1.0}), vector_of({1.0, 6.0})}),
      ElementsAre(0, 1, 4));
  EXPECT_TRUE(optimize::pareto_front({}).empty());
  EXPECT_THROW(
      optimize::pareto_front({vector_of({1.0}), vector_of({1.0, 2.0})}),
      InvalidInput);
  EXPECT_THROW(optimize::pareto_front({vector_of({std::nan("")})}),
               InvalidInput);
}

// Least x^2 + y^2 against least (x - 1)^2 + y^2: the front is y = 0.
optimize::MinimizeProblem two_bowls() {
  return {
      {{"x", 0.3, -2.0, 2.0}, {"y", 0.7, -2.0, 2.0}},
      "left",
      {{.name = "right"}},
      [](const VectorX& x) {
        const double y = x[1] * x[1];
        return optimize::VectorAnswer{
            .values =
                vector_of({x[0] * x[0] + y, (x[0] - 1.0) * (x[0] - 1.0) + y}),
            .failure = {}};
      },
      [](const VectorX& x) {
        Eigen::MatrixXd jacobian(2, 2);
        jacobian << 2.0 * x[0], 2.0 * x[1], 2.0 * x[0] - 2.0, 2.0 * x[1];
        return optimize::JacobianAnswer{.jacobian = jacobian, .failure = {}};
      }};
}

TEST(EpsilonConstraints, FindTheWholeFront) {
  const optimize::MinimizeProblem problem = two_bowls();
  const optimize::MinimizeOptions options{.optimality_tolerance = 1e-8};
  const optimize::MinimizeReport left = optimize::minimize(problem, options);
  const optimize::MinimizeReport right =
      optimize::minimize(optimize::exchanged(problem, 0), options);
  EXPECT_NEAR(left.best[0], 0.0, 1e-6);
  EXPECT_NEAR(right.best[0], 1.0, 1e-6);
  EXPECT_NEAR(right.values[1], 1.0, 1e-6);
  const VectorX levels =
      optimize::epsilon_levels(right.objective, left.values[1], 7);
  EXPECT_NEAR(levels[0], 7.0 / 8.0, 1e-6);
  EXPECT_NEAR(levels[6], 1.0 / 8.0, 1e-6);
  std::vector<VectorX> points;
  for (const double level : levels) {
    const optimize::MinimizeReport report = optimize::minimize(
        optimize::with_upper_bound(problem, 0, level), options);
    EXPECT_EQ(report.termination, optimize::Termination::Converged)
        << report.message;
    // sqrt(left) + sqrt(right) = 1 along the front.
    EXPECT_NEAR(std::sqrt(report.values[0]) + std::sqrt(report.values[1]), 1.0,
                1e-6);
    points.push_back(report.values);
  }
  EXPECT_EQ(optimize::pareto_front(points).size(), points.size());
  EXPECT_THROW(optimize::with_upper_bound(problem, 1, 0.0), InvalidInput);
  EXPECT_THROW(optimize::epsilon_levels(1.0, 0.0, 3), InvalidInput);
}

TEST(Spread, FirstOrderAgreesWithSamplesOfALinearFunction) {
  Eigen::MatrixXd jacobian(2, 3);
  jacobian << 3.0, -4.0, 0.0, 0.0, 0.0, 0.0;
  const VectorX deviations = vector_of({0.1, 0.1, 5.0});
  const samples::LinearSpread linear =
      samples::linear_spread(jacobian, deviations);
  EXPECT_NEAR(linear.deviation[0], 0.5, 1e-15);
  EXPECT_NEAR(linear.shares(0, 0), 0.36, 1e-15);
  EXPECT_NEAR(linear.shares(0, 1), 0.64, 1e-15);
  EXPECT_EQ(linear.deviation[1], 0.0);
  const VectorX mean = vector_of({1.0, 2.0, 3.0});
  std::vector<VectorX> values;
  for (const VectorX& x : samples::normal_designs(
           mean, deviations, samples::sobol_samples(3, 4095))) {
    values.push_back(jacobian * x);
  }
  const samples::SampledSpread sampled = samples::sampled_spread(values);
  // Low-discrepancy samples do better than the error bars of random ones.
  EXPECT_NEAR(sampled.deviation[0], 0.5, sampled.deviation_error[0]);
  EXPECT_NEAR(sampled.mean[0], -5.0, sampled.mean_error[0]);
  EXPECT_NEAR(sampled.deviation_error[0], 0.5 / std::sqrt(2.0 * 4095.0),
              0.1 * 0.5 / std::sqrt(2.0 * 4095.0));
  EXPECT_EQ(sampled.deviation[1], 0.0);
  EXPECT_LT(sampled.least[0], -6.0);
  EXPECT_GT(sampled.largest[0], -4.0);
}

TEST(Spread, TheSecondOrderTermIsWhatFirstOrderLeavesOut) {
  // f = x^2 about 1: variance 4 d^2 + 2 d^4, so the error falls with d^2.
  const auto miss = [](double d) {
    std::vector<VectorX> values;
    for (const VectorX& x :
         samples::normal_designs(vector_of({1.0}), vector_of({d}),
                                 samples::sobol_samples(1, 65535))) {
      values.push_back(x.cwiseAbs2());
    }
    const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Constant(1, 1, 2.0);
    const double linear =
        samples::linear_spread(jacobian, vector_of({d})).deviation[0];
    return samples::sampled_spread(values).deviation[0] / linear - 1.0;
  };
  EXPECT_NEAR(miss(0.4), std::sqrt(1.0 + 0.08) - 1.0, 2e-3);
  EXPECT_NEAR(std::log2(miss(0.4) / miss(0.2)), 2.0, 0.1);
}

TEST(Spread, RefusesWhatCannotBe) {
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Ones(1, 2);
  EXPECT_THROW(samples::linear_spread(jacobian, vector_of({1.0})),
               InvalidInput);
  EXPECT_THROW(samples::linear_spread(jacobian, vector_of({1.0, -1.0})),
               InvalidInput);
  EXPECT_THROW(samples::sampled_spread({vector_of({1.0})}), InvalidInput);
  EXPECT_THROW(
      samples::sampled_spread({vector_of({1.0}), vector_of({1.0, 2.0})}),
      InvalidInput);
  EXPECT_THROW(samples::normal_designs(vector_of({1.0}), vector_of({1.0}),
                                       {VectorX::Zero(2)}),
               InvalidInput);
}

}  // namespace
}  // namespace meniscus::pareto_test
