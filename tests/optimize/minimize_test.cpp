#include "optimize/minimize.h"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/support/standard_problems.h"

namespace meniscus::minimize_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using tests::StandardProblem;
using tests::vector_of;

// Published optima have seven digits.
constexpr double kPublished = 2e-6;
// A residual of 1e-5 may leave about as much, of the scale, at each bound.
constexpr double kByGradients = 3e-5;
// Steps below 1e-6 of the range, and multipliers to 1e-6.
constexpr double kWithoutGradients = 2e-4;

double relative(double value, double expected) {
  return std::abs(value - expected) / std::max(1.0, std::abs(expected));
}

class EveryProblem
    : public testing::TestWithParam<std::tuple<int, const char*>> {
 protected:
  StandardProblem problem() const {
    return tests::standard_problems()[static_cast<std::size_t>(
        std::get<0>(GetParam()))];
  }
  const char* method() const { return std::get<1>(GetParam()); }
};
class ByGradients : public EveryProblem {};
class WithoutGradients : public EveryProblem {};

TEST_P(ByGradients, IsSolvedToTheFirstOrderConditions) {
  const StandardProblem known = problem();
  // Separable models creep along a curved valley: thousands of steps.
  const bool creeps = (known.name == "rosenbrock" || known.name == "hs6") &&
                      method() != std::string("slsqp");
  const double tolerance = creeps ? 1e-3 : 1e-5;
  const optimize::MinimizeReport report =
      optimize::minimize(known.problem, {.method = method(),
                                         .optimality_tolerance = tolerance,
                                         .max_evaluations = 3000});
  RecordProperty("evaluations", report.evaluations);
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_TRUE(report.feasible);
  EXPECT_LT(relative(report.objective, known.least),
            creeps ? 2e-3 : kByGradients + kPublished);
  ASSERT_TRUE(report.first_order);
  EXPECT_LE(report.first_order->residual, tolerance);
  EXPECT_LE(report.first_order->violation, 1e-6);
  EXPECT_EQ(report.jacobian, known.problem.jacobian(report.best).jacobian);
  if (method() == std::string("slsqp")) {
    EXPECT_LE(report.evaluations, 60) << report.message;
    EXPECT_LE(report.gradient_evaluations, report.evaluations);
  }
}

TEST_P(ByGradients, IsSolvedByDifferences) {
  StandardProblem known = problem();
  known.problem.jacobian = {};
  const optimize::MinimizeReport report =
      optimize::minimize(known.problem, {.method = method(),
                                         .optimality_tolerance = 1e-4,
                                         .max_evaluations = 10000,
                                         .difference_step = 1e-6});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_LT(relative(report.objective, known.least), 1e-4);
  EXPECT_EQ(report.gradient_evaluations, 0);
}

TEST_P(WithoutGradients, IsSolvedToTheStepTolerance) {
  StandardProblem known = problem();
  known.problem.jacobian = {};
  const optimize::MinimizeReport report = optimize::minimize(
      known.problem, {.method = method(), .max_evaluations = 200000});
  RecordProperty("evaluations", report.evaluations);
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_TRUE(report.feasible);
  EXPECT_LT(relative(report.objective, known.least), kWithoutGradients);
}

std::string case_name(
    const testing::TestParamInfo<std::tuple<int, const char*>>& info) {
  const auto [index, method] = info.param;
  return tests::standard_problems()[static_cast<std::size_t>(index)].name +
         "_" + method;
}

INSTANTIATE_TEST_SUITE_P(Standard, ByGradients,
                         testing::Combine(testing::Range(0, 7),
                                          testing::Values("slsqp", "mma",
                                                          "ccsa")),
                         case_name);
INSTANTIATE_TEST_SUITE_P(Standard, WithoutGradients,
                         testing::Combine(testing::Range(0, 7),
                                          testing::Values("bobyqa", "cobyla",
                                                          "sbplx",
                                                          "neldermead")),
                         case_name);

class Global : public testing::TestWithParam<const char*> {};

TEST_P(Global, FindsTheLowestOfSixValleys) {
  for (const bool fenced : {false, true}) {
    const StandardProblem known =
        fenced ? tests::fenced_camel() : tests::camel(-1.6, 1.7);
    const optimize::MinimizeReport report = optimize::minimize(
        known.problem,
        {.method = GetParam(), .max_evaluations = 2000, .seed = 7});
    EXPECT_EQ(report.termination, optimize::Termination::Converged)
        << report.message;
    EXPECT_LT(relative(report.objective, known.least), 1e-6);
    EXPECT_LE(report.evaluations, 2000);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Global,
                         testing::Values("isres", "crs2", "direct_l"));

TEST(Minimize, ALocalMethodStaysInItsValley) {
  const optimize::MinimizeReport report =
      optimize::minimize(tests::camel(-1.6, 1.7).problem, {.method = "bobyqa"});
  EXPECT_GT(report.objective, -1.0);
}

TEST(Minimize, KnowsTheMultipliers) {
  // HS43 at (0, 1, 2, -1): constraints a and c hold with 1 and 2.
  const StandardProblem known = tests::standard_problems()[4];
  const optimize::MinimizeReport report =
      optimize::minimize(known.problem, {.optimality_tolerance = 1e-7});
  ASSERT_EQ(report.constraints.size(), 3U);
  EXPECT_NEAR(report.constraints[0].multiplier, 1.0, 1e-4);
  EXPECT_NEAR(report.constraints[1].multiplier, 0.0, 1e-4);
  EXPECT_NEAR(report.constraints[2].multiplier, 2.0, 1e-4);
  EXPECT_NEAR(report.constraints[1].value, 9.0, 1e-4);
  EXPECT_TRUE(report.constraints[0].satisfied);
}

TEST(Minimize, AMultiplierIsWhatABoundCosts) {
  StandardProblem known = tests::standard_problems()[6];
  const optimize::MinimizeOptions options{.optimality_tolerance = 1e-8};
  const optimize::MinimizeReport report =
      optimize::minimize(known.problem, options);
  const double step = 1e-3;
  known.problem.constraints[0].upper = 1.0 + step;
  const double above = optimize::minimize(known.problem, options).objective;
  known.problem.constraints[0].upper = 1.0 - step;
  const double below = optimize::minimize(known.problem, options).objective;
  EXPECT_NEAR(report.constraints[0].multiplier, -(above - below) / (2.0 * step),
              1e-5);
}

TEST(Minimize, DoesNotDependOnUnits) {
  // Lengths in micrometres, the objective in thousandths: the same sequence.
  const StandardProblem known = tests::standard_problems()[5];
  optimize::MinimizeProblem other = known.problem;
  const double unit = 1024.0;  // exact
  for (optimize::Variable& variable : other.variables) {
    variable.initial *= unit;
    variable.lower *= unit;
    variable.upper *= unit;
  }
  other.function = [&known, unit](const VectorX& x) {
    optimize::VectorAnswer answer = known.problem.function(x / unit);
    answer.values[0] *= 4096.0;
    return answer;
  };
  other.jacobian = [&known, unit](const VectorX& x) {
    optimize::JacobianAnswer answer = known.problem.jacobian(x / unit);
    answer.jacobian /= unit;
    answer.jacobian.row(0) *= 4096.0;
    return answer;
  };
  const optimize::MinimizeReport a = optimize::minimize(known.problem);
  const optimize::MinimizeReport b = optimize::minimize(other);
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_LT((a.best - b.best / unit).norm(), 1e-9);
}

TEST(Minimize, AStartAtTheMinimumEndsAtOnce) {
  StandardProblem known = tests::standard_problems()[0];
  known.problem.variables[0].initial = 1.0;
  known.problem.variables[1].initial = 1.0;
  const optimize::MinimizeReport report = optimize::minimize(known.problem);
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  // The gradient is exactly zero: probes tell a minimum from a constant.
  EXPECT_LE(report.evaluations, 4);
  EXPECT_EQ(report.best, vector_of({1.0, 1.0}));
}

TEST(Minimize, PrecisionFinerThanTheMeshIsSaid) {
  StandardProblem known = tests::standard_problems()[6];
  const optimize::MinimizeReport report = optimize::minimize(
      known.problem, {.value_error = vector_of({0.01, 0.03})});
  EXPECT_THAT(report.message,
              AllOf(HasSubstr("below the mesh's own error"),
                    HasSubstr("'deflection' stands"), HasSubstr("0.03")));
  EXPECT_EQ(optimize::precision_note(known.problem, report, 0.1,
                                     vector_of({0.01, 0.0})),
            "");
  EXPECT_EQ(optimize::precision_note(known.problem, report, 0.1, {}), "");
}

TEST(Minimize, MessagesHaveUnits) {
  // Masses are counted in tonnes and shown in kg.
  optimize::MinimizeProblem problem{
      .variables = {{.name = "height",
                     .initial = 1.5,
                     .lower = 1.0,
                     .upper = 2.0,
                     .shown = {1.0, "mm"}}},
      .objective = "sag",
      .constraints = {{.name = "weight",
                       .upper = 5e-4,
                       .shown = {1000.0, "kg"}}},
      .function =
          [](const VectorX& x) {
            return optimize::VectorAnswer{
                .values = vector_of({1.0 / x[0], 1e-3 * x[0]}), .failure = {}};
          },
      .shown = {1.0, "mm"}};
  const optimize::MinimizeReport missed = optimize::minimize(problem);
  EXPECT_EQ(missed.termination, optimize::Termination::Infeasible);
  EXPECT_THAT(missed.message,
              AllOf(HasSubstr("height = 1 mm, 'weight' is 1 kg and must be at "
                              "most 0.5 kg"),
                    HasSubstr("height at its lower bound 1 mm")));
  problem.constraints[0].upper = 1.7e-3;
  const optimize::MinimizeReport found = optimize::minimize(problem);
  EXPECT_EQ(found.termination, optimize::Termination::Converged);
  EXPECT_THAT(found.message, HasSubstr(" mm at height = 1.7 mm"));
}

TEST(StandardProblems, HaveExactJacobians) {
  // Taylor: |f(x + h d) - f(x) - h J d| falls by 4 when h halves.
  for (const StandardProblem& known : tests::standard_problems()) {
    VectorX x = known.solution;
    const VectorX d = VectorX::LinSpaced(x.size(), 0.3, -0.7);
    x = x.array() + 0.05;
    const VectorX slope = known.problem.jacobian(x).jacobian * d;
    const VectorX f = known.problem.function(x).values;
    const auto rest = [&](double h) {
      return (known.problem.function(x + h * d).values - f - h * slope).norm();
    };
    EXPECT_NEAR(std::log2(rest(2e-3) / rest(1e-3)), 2.0, 0.05) << known.name;
    const VectorX at = known.problem.function(known.solution).values;
    EXPECT_LT(relative(at[0], known.least), 1e-4) << known.name;
  }
}

}  // namespace
}  // namespace meniscus::minimize_test
