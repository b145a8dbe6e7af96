#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "optimize/minimize.h"
#include "tests/support/standard_problems.h"

namespace meniscus::minimize_boxes_test {
namespace {

using tests::vector_of;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// Boxes solved to the end, each, took 124 evaluations here; left once they are
// used up, 64.
constexpr int kEvaluations = 90;

// A bent tunnel: what is more than 0.3 off y = x^2 cannot be evaluated. From
// (-2, 4) straight steps hit its walls, and only small boxes lead along it.
optimize::MinimizeProblem tunnel() {
  optimize::MinimizeProblem problem{
      .variables = {{"x", -2.0, -4.0, 6.0}, {"y", 4.0, -10.0, 20.0}},
      .objective = "mass",
      .constraints = {{"floor", 0.0, kUnbounded, 1.0},
                      {"lid", -kUnbounded, 0.2, 1.0}}};
  problem.function = [](const VectorX& x) -> optimize::VectorAnswer {
    const double above = x[1] - x[0] * x[0];
    if (std::abs(above) > 0.3) {
      return {.values = {},
              .failure = Failure{FailureKind::FilmPinched, "the neck closes"}};
    }
    const double mass = 30.0 - 2.0 * x[0] + 0.1 * x[0] * x[0];
    return {.values = vector_of({mass, above, above}), .failure = {}};
  };
  problem.jacobian = [](const VectorX& x) -> optimize::JacobianAnswer {
    Eigen::MatrixXd jacobian(3, 2);
    jacobian << -2.0 + 0.2 * x[0], 0.0,  //
        -2.0 * x[0], 1.0,                //
        -2.0 * x[0], 1.0;
    return {.jacobian = jacobian, .failure = {}};
  };
  return problem;
}

class Tunnel : public testing::TestWithParam<const char*> {};

TEST_P(Tunnel, IsFollowedToItsEnd) {
  // The mass falls with x, and x^2 <= y <= 20.
  const double end = std::sqrt(20.0);
  const optimize::MinimizeReport report = optimize::minimize(
      tunnel(), {.method = GetParam(), .max_evaluations = 1000});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.best[0], end, 1e-4) << report.message;
  if (GetParam() == std::string("slsqp")) {  // others take shorter steps
    EXPECT_GT(report.failed_evaluations, 0);
  }
  EXPECT_LE(report.evaluations, kEvaluations) << report.message;
}

// (x - 2)^2 + (y - 1)^2 along x = y: least, 1/2, at (3/2, 3/2).
optimize::MinimizeProblem along_diagonal(const VectorX& start) {
  optimize::MinimizeProblem problem;
  problem.variables = {{"x", start[0], -5.0, 5.0}, {"y", start[1], -5.0, 5.0}};
  problem.objective = "distance";
  problem.constraints = {{.name = "x - y", .lower = 0.0, .upper = 0.0}};
  problem.function = [](const VectorX& x) -> optimize::VectorAnswer {
    const double distance =
        (x[0] - 2.0) * (x[0] - 2.0) + (x[1] - 1.0) * (x[1] - 1.0);
    return {.values = vector_of({distance, x[0] - x[1]}), .failure = {}};
  };
  problem.jacobian = [](const VectorX& x) -> optimize::JacobianAnswer {
    Eigen::MatrixXd jacobian(2, 2);
    jacobian << 2.0 * (x[0] - 2.0), 2.0 * (x[1] - 1.0),  //
        1.0, -1.0;
    return {.jacobian = jacobian, .failure = {}};
  };
  return problem;
}

class OneSided : public testing::TestWithParam<const char*> {};

// From below the line the objective pulls through it; from above its own
// minimum lies on the free side, and the side has to turn.
TEST_P(OneSided, EquationsAreKeptFromEitherSide) {
  for (const VectorX& start : {vector_of({3.0, 0.0}), vector_of({0.0, 3.0})}) {
    const optimize::MinimizeReport report =
        optimize::minimize(along_diagonal(start), {.method = GetParam()});
    EXPECT_EQ(report.termination, optimize::Termination::Converged)
        << report.message;
    EXPECT_NEAR(report.objective, 0.5, 1e-4) << report.message;
    EXPECT_LE(report.evaluations, kEvaluations) << report.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, OneSided, testing::Values("mma", "ccsa"));

INSTANTIATE_TEST_SUITE_P(Methods, Tunnel,
                         testing::Values("slsqp", "mma", "ccsa"));

}  // namespace
}  // namespace meniscus::minimize_boxes_test
