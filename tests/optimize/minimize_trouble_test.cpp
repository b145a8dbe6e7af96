#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <gmock/gmock.h>

#include "optimize/minimize.h"
#include "tests/support/standard_problems.h"

namespace meniscus::minimize_trouble_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using tests::vector_of;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kNoBound = std::numeric_limits<double>::infinity();

optimize::VectorAnswer pinched_answer() {
  return {.values = {},
          .failure = Failure{FailureKind::FilmPinched, "the neck closes"}};
}
optimize::VectorAnswer values(const VectorX& all) {
  return {.values = all, .failure = {}};
}
optimize::JacobianAnswer one_row(double a, double b) {
  Eigen::MatrixXd jacobian(1, 2);
  jacobian << a, b;
  return {.jacobian = jacobian, .failure = {}};
}

// A bowl with its minimum at (6, 3), within [0, 10]^2, started at (1, 1).
double bowl(const VectorX& x) {
  return 2.0 + std::pow(x[0] - 6.0, 2) + 3.0 * std::pow(x[1] - 3.0, 2) +
         0.5 * (x[0] - 6.0) * (x[1] - 3.0);
}
optimize::JacobianAnswer bowl_slope(const VectorX& x) {
  return one_row(2.0 * (x[0] - 6.0) + 0.5 * (x[1] - 3.0),
                 6.0 * (x[1] - 3.0) + 0.5 * (x[0] - 6.0));
}
optimize::MinimizeProblem bowl_problem() {
  return {{{"a", 1.0, 0.0, 10.0}, {"b", 1.0, 0.0, 10.0}},
          "mass",
          {},
          [](const VectorX& x) { return values(vector_of({bowl(x)})); },
          bowl_slope};
}

class Trouble : public testing::TestWithParam<const char*> {
 protected:
  optimize::MinimizeOptions options() const {
    return {.method = GetParam(), .max_evaluations = 2000};
  }
  optimize::MinimizeMethod method() const {
    return *optimize::find_minimize_method(GetParam());
  }
  bool global() const { return method().global; }
};

TEST_P(Trouble, ARegionThatFailsIsSteppedBackFrom) {
  // The first steps of most methods land beyond x + y = 11.
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX& x) {
    return x.sum() > 11.0 ? pinched_answer() : values(vector_of({bowl(x)}));
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.objective, 2.0, 1e-3) << report.message;
}

TEST_P(Trouble, AMinimumBesideAWallIsFoundAndTheWallNamed) {
  // Half of the space fails, and the bowl leans against it.
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX& x) {
    return x[0] > 5.0 ? pinched_answer() : values(vector_of({bowl(x)}));
  };
  const double least = bowl(vector_of({5.0, 3.0 + 0.5 / 6.0}));
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_LT(report.best[0], 5.0 + 1e-12);
  // A gradient cannot slide along a wall that only failures show, the simplex
  // that takes over can.
  EXPECT_LT(report.objective, 1.05 * least) << report.message;
  EXPECT_GT(report.failed_evaluations, 0);
  EXPECT_THAT(report.message, HasSubstr("could not be evaluated"));
  EXPECT_THAT(report.message, HasSubstr("the neck closes"));
}

TEST_P(Trouble, NaNIsAPointThatFails) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX& x) {
    return values(vector_of({x.sum() > 11.0 ? kNotANumber : bowl(x)}));
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.objective, 2.0, 1e-3);
}

TEST_P(Trouble, AFailingStartIsLeft) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX& x) {
    return x[0] < 2.0 ? pinched_answer() : values(vector_of({bowl(x)}));
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.objective, 2.0, 1e-3);
}

TEST_P(Trouble, EveryPointFailingSaysWhatToChange) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX&) { return pinched_answer(); };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::NoFeasible);
  EXPECT_EQ(report.best.size(), 0);
  EXPECT_LE(report.evaluations, 20);
  EXPECT_THAT(report.message,
              AllOf(HasSubstr("film_pinched"), HasSubstr("the neck closes"),
                    HasSubstr("a = 1"), HasSubstr("bounds")));
}

TEST_P(Trouble, NaNEverywhereNamesTheExpression) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX&) {
    return values(vector_of({kNotANumber}));
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::NoFeasible);
  EXPECT_THAT(report.message,
              AllOf(HasSubstr("not_a_number"), HasSubstr("'mass' is nan"),
                    HasSubstr("division by zero")));
}

TEST_P(Trouble, AConstantObjectiveSaysSo) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [](const VectorX&) { return values(vector_of({0.4})); };
  problem.jacobian = [](const VectorX&) { return one_row(0.0, 0.0); };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::Constant)
      << report.message;
  EXPECT_LE(report.evaluations, 14);
  EXPECT_EQ(report.objective, 0.4);
  EXPECT_THAT(report.message, AllOf(HasSubstr("no design variable changes"),
                                    HasSubstr("Choose another objective")));
}

TEST_P(Trouble, ConstraintsThatExcludeEachOtherAreNamed) {
  // a + b >= 8 and a + b <= 4, b <= 100.
  optimize::MinimizeProblem problem = bowl_problem();
  problem.constraints = {{"stiffness", 8.0, kNoBound, {}},
                         {"stress", -kNoBound, 4.0, {}},
                         {"height", -kNoBound, 100.0, {}}};
  problem.function = [](const VectorX& x) {
    return values(vector_of({bowl(x), x.sum(), x.sum(), x[1]}));
  };
  problem.jacobian = [](const VectorX& x) {
    Eigen::MatrixXd jacobian(4, 2);
    jacobian << bowl_slope(x).jacobian, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0;
    return optimize::JacobianAnswer{.jacobian = jacobian, .failure = {}};
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  // Global and simplex methods try until the budget is spent.
  EXPECT_TRUE(report.termination == optimize::Termination::Infeasible ||
              report.termination == optimize::Termination::LimitReached)
      << report.message;
  EXPECT_FALSE(report.feasible);
  EXPECT_THAT(report.message,
              AllOf(HasSubstr("must be at"), HasSubstr("stress"),
                    Not(HasSubstr("height"))));
  // The nearest: the violations (8 - s) / 8 and (s - 4) / 4 are alike.
  EXPECT_LT(report.constraints[0].violation, 1.01);
  EXPECT_LT(report.constraints[1].violation, 1.01);
}

TEST_P(Trouble, HeldVariablesStay) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.variables[1] = {"b", 2.0, 2.0, 2.0};
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_EQ(report.best[1], 2.0);
  EXPECT_NEAR(report.best[0], 6.25, 2e-3);
  problem.variables[0] = {"a", 1.0, 1.0, 1.0};
  const optimize::MinimizeReport none = optimize::minimize(problem, options());
  EXPECT_EQ(none.termination, optimize::Termination::NoFreedom);
  EXPECT_EQ(none.evaluations, 1);
  EXPECT_EQ(none.objective, bowl(vector_of({1.0, 2.0})));
  EXPECT_THAT(none.message, AllOf(HasSubstr("'a'"), HasSubstr("Widen")));
}

TEST_P(Trouble, AJumpDoesNotLoseTheBestPoint) {
  optimize::MinimizeProblem problem = bowl_problem();
  double best = kNoBound;
  problem.function = [&best](const VectorX& x) {
    const double jump = std::floor(3.0 * x[0]) * 0.7 +
                        (std::sin(40.0 * x[1]) > 0.0 ? 1.0 : 0.0);
    best = std::min(best, bowl(x) + jump);
    return values(vector_of({bowl(x) + jump}));
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, options());
  // A point that meets the conditions goes before one better by 1e-4 x scale.
  EXPECT_LE(report.objective, best + 1e-4 * bowl(vector_of({1.0, 1.0})));
  EXPECT_LE(report.evaluations, 2000);
}

TEST_P(Trouble, WhatTheFunctionThrowsArrives) {
  int calls = 0;
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [&calls](const VectorX& x) -> optimize::VectorAnswer {
    if (++calls == 3) {
      throw IoError("disk full");
    }
    return values(vector_of({bowl(x)}));
  };
  EXPECT_THROW(optimize::minimize(problem, options()), IoError);
  EXPECT_EQ(calls, 3);
}

TEST_P(Trouble, StopsOnRequest) {
  struct StopAfter : Monitor {
    int* calls = nullptr;
    bool stop_requested() const override { return *calls >= 2; }
  };
  int calls = 0;
  StopAfter monitor;
  monitor.calls = &calls;
  optimize::MinimizeProblem problem = bowl_problem();
  problem.function = [&calls](const VectorX& x) {
    ++calls;
    return values(vector_of({bowl(x)}));
  };
  optimize::MinimizeOptions with_monitor = options();
  with_monitor.monitor = &monitor;
  EXPECT_THROW(optimize::minimize(problem, with_monitor), Interrupted);
  EXPECT_EQ(calls, 2);
}

TEST_P(Trouble, BudgetsHoldAndTheIncumbentIsKept) {
  for (const int budget : {1, 2, 3, 5}) {
    double best = kNoBound;
    int calls = 0;
    optimize::MinimizeProblem problem = bowl_problem();
    problem.function = [&](const VectorX& x) {
      ++calls;
      best = std::min(best, bowl(x));
      return values(vector_of({bowl(x)}));
    };
    optimize::MinimizeOptions limited = options();
    limited.max_evaluations = budget;
    const optimize::MinimizeReport report =
        optimize::minimize(problem, limited);
    EXPECT_LE(calls, budget);
    EXPECT_EQ(report.evaluations, calls);
    EXPECT_EQ(report.objective, best);
    EXPECT_EQ(report.termination, optimize::Termination::LimitReached);
    EXPECT_THAT(report.message, HasSubstr("limit of"));
  }
  optimize::MinimizeOptions limited = options();
  limited.time_limit = 1e-9;
  const optimize::MinimizeReport report =
      optimize::minimize(bowl_problem(), limited);
  EXPECT_EQ(report.termination, optimize::Termination::LimitReached);
  EXPECT_THAT(report.message, HasSubstr("time limit"));
}

// Runs hs71 or the bowl; `known`: answers of an earlier run are replayed.
struct Tape {
  std::vector<VectorX> points;
  std::vector<VectorX> slopes;

  optimize::MinimizeReport run(optimize::MinimizeProblem problem,
                               const optimize::MinimizeOptions& options) {
    const optimize::VectorFunction function = problem.function;
    problem.function = [this, function](const VectorX& x) {
      points.push_back(x);
      return function(x);
    };
    if (problem.jacobian) {
      const optimize::JacobianFunction jacobian = problem.jacobian;
      problem.jacobian = [this, jacobian](const VectorX& x) {
        slopes.push_back(x);
        return jacobian(x);
      };
    }
    return optimize::minimize(problem, options);
  }
};

TEST_P(Trouble, TheSequenceRepeatsBitForBitAndNoPointTwice) {
  for (const bool fails : {false, true}) {
    optimize::MinimizeProblem problem = tests::standard_problems()[6].problem;
    if (fails) {
      const optimize::VectorFunction whole = problem.function;
      problem.function = [whole](const VectorX& x) {
        return x[0] < 5.5 ? pinched_answer() : whole(x);
      };
      problem.variables[0].initial = 7.0;
    }
    optimize::MinimizeOptions limited = options();
    limited.max_evaluations = 120;
    Tape first;
    Tape second;
    const optimize::MinimizeReport a = first.run(problem, limited);
    const optimize::MinimizeReport b = second.run(problem, limited);
    EXPECT_EQ(first.points, second.points);
    EXPECT_EQ(first.slopes, second.slopes);
    EXPECT_EQ(a.best, b.best);
    EXPECT_EQ(a.message, b.message);
    for (std::size_t i = 0; i < first.points.size(); ++i) {
      const VectorX& x = first.points[i];
      for (Eigen::Index j = 0; j < x.size(); ++j) {
        const auto& variable = problem.variables[static_cast<std::size_t>(j)];
        const double number = x[j];
        EXPECT_TRUE(number >= variable.lower && number <= variable.upper);
      }
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_NE(x, first.points[j]) << i << " " << j;
      }
    }
  }
}

TEST_P(Trouble, ALongerBudgetContinuesTheSameSequence) {
  if (global()) {
    return;  // its share of the budget ends the wide search earlier
  }
  const optimize::MinimizeProblem problem =
      tests::standard_problems()[5].problem;
  optimize::MinimizeOptions limited = options();
  limited.max_evaluations = 9;
  Tape first;
  Tape second;
  first.run(problem, limited);
  second.run(problem, options());
  ASSERT_GE(second.points.size(), first.points.size());
  second.points.resize(first.points.size());
  EXPECT_EQ(first.points, second.points);
}

INSTANTIATE_TEST_SUITE_P(Methods, Trouble,
                         testing::Values("slsqp", "mma", "ccsa", "bobyqa",
                                         "cobyla", "sbplx", "neldermead",
                                         "isres", "crs2", "direct_l"));

TEST(MinimizeInput, RefusesWhatCannotWork) {
  const auto refusal =
      [](const optimize::MinimizeProblem& problem,
         const optimize::MinimizeOptions& options) -> std::string {
    try {
      optimize::minimize(problem, options);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  const optimize::MinimizeProblem good = bowl_problem();
  EXPECT_THAT(
      refusal(good, {.method = "newton"}),
      AllOf(HasSubstr("'newton'"), HasSubstr("slsqp"), HasSubstr("isres")));
  EXPECT_THAT(refusal(good, {.optimality_tolerance = 0.0}),
              HasSubstr("optimality_tolerance"));
  EXPECT_THAT(refusal(good, {.max_evaluations = 0}), HasSubstr("at least 1"));
  optimize::MinimizeProblem bad = good;
  bad.variables.clear();
  EXPECT_THAT(refusal(bad, {}), HasSubstr("no design variable"));
  bad = good;
  bad.constraints = {{"stress", 2.0, 1.0, {}}};
  EXPECT_THAT(refusal(bad, {}),
              AllOf(HasSubstr("'stress'"), HasSubstr("swap")));
  bad.constraints = {{"stress", 0.0, 1.0, {}}};
  EXPECT_THAT(refusal(bad, {}), HasSubstr("1 values; expected 2"));
  bad = good;
  bad.jacobian = [](const VectorX&) {
    return optimize::JacobianAnswer{.jacobian = Eigen::MatrixXd::Zero(2, 2),
                                    .failure = {}};
  };
  EXPECT_THAT(refusal(bad, {}), HasSubstr("Jacobian is 2 x 2"));
}

TEST(MinimizeJacobian, OneThatFailsIsReplacedByDifferences) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.jacobian = [](const VectorX&) {
    return optimize::JacobianAnswer{
        .jacobian = {}, .failure = Failure{FailureKind::SolverFailed, "dual"}};
  };
  const optimize::MinimizeReport report =
      optimize::minimize(problem, {.optimality_tolerance = 1e-3});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.objective, 2.0, 1e-3);
}

TEST(MinimizePhases, AreAnnouncedAndNeighboursTold) {
  optimize::MinimizeProblem problem = bowl_problem();
  problem.jacobian = {};
  std::vector<VectorX> told;
  std::vector<optimize::EvaluationPhase> phases;
  Tape tape;
  tape.run(
      problem,
      {.optimality_tolerance = 1e-3,
       .announce =
           [&](optimize::EvaluationPhase phase) { phases.push_back(phase); },
       .prefetch =
           [&](const std::vector<VectorX>& points) {
             told.insert(told.end(), points.begin(), points.end());
           }});
  ASSERT_GE(told.size(), 2U);
  EXPECT_EQ(phases[0], optimize::EvaluationPhase::Start);
  EXPECT_EQ(phases[1], optimize::EvaluationPhase::Difference);
  EXPECT_EQ(tape.points[1], told[0]);
  EXPECT_EQ(tape.points[2], told[1]);
  EXPECT_EQ(phases[3], optimize::EvaluationPhase::Step);
}

}  // namespace
}  // namespace meniscus::minimize_trouble_test
