#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "optimize/minimize.h"
#include "tests/optimize/standard_problems.h"

namespace meniscus {
namespace {

using tests::vector_of;

constexpr double kInf = std::numeric_limits<double>::infinity();
// Boxes solved to the end, each, took 124 evaluations here; left once they are
// used up, 64.
constexpr int kEvaluations = 90;

// A bent tunnel: what is more than 0.3 off y = x^2 cannot be evaluated. From
// (-2, 4) straight steps hit its walls, and only small boxes lead along it.
MinimizeProblem tunnel() {
  MinimizeProblem problem{
      .variables = {{"x", -2.0, -4.0, 6.0}, {"y", 4.0, -10.0, 20.0}},
      .objective = "mass",
      .constraints = {{"floor", 0.0, kInf, 1.0}, {"lid", -kInf, 0.2, 1.0}}};
  problem.function = [](const VectorX& x) -> VectorAnswer {
    const double above = x[1] - x[0] * x[0];
    if (std::abs(above) > 0.3) {
      return {.values = {},
              .failure = Failure{FailureKind::FilmPinched, "the neck closes"}};
    }
    const double mass = 30.0 - 2.0 * x[0] + 0.1 * x[0] * x[0];
    return {.values = vector_of({mass, above, above}), .failure = {}};
  };
  problem.jacobian = [](const VectorX& x) -> JacobianAnswer {
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
  const MinimizeReport report =
      minimize(tunnel(), {.method = GetParam(), .max_evaluations = 1000});
  EXPECT_EQ(report.termination, Termination::Converged) << report.message;
  EXPECT_NEAR(report.best[0], end, 1e-4) << report.message;
  if (GetParam() == std::string("slsqp")) {  // others take shorter steps
    EXPECT_GT(report.failed_evaluations, 0);
  }
  EXPECT_LE(report.evaluations, kEvaluations) << report.message;
}

INSTANTIATE_TEST_SUITE_P(Methods, Tunnel,
                         testing::Values("slsqp", "mma", "ccsa"));

}  // namespace
}  // namespace meniscus
