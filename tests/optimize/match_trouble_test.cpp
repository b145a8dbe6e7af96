#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "optimize/problem.h"

namespace meniscus::match_trouble_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::vector<optimize::Variable> kUnit = {{"width", 0.0, 0.0, 10.0}};

optimize::ResidualAnswer answer_of(double residual) {
  optimize::ResidualAnswer answer;
  answer.residuals = VectorX::Constant(1, residual);
  answer.mismatch = answer.residuals.cwiseAbs();
  return answer;
}

optimize::ResidualAnswer pinched() {
  optimize::ResidualAnswer answer;
  answer.failure = Failure{FailureKind::FilmPinched, "the neck closes"};
  return answer;
}

// The message of the InvalidInput that a match throws.
std::string refusal(const std::vector<optimize::Variable>& variables,
                    const optimize::MatchOptions& options) {
  try {
    optimize::match(
        variables, [](const VectorX& x) { return answer_of(x[0]); }, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

class MatchTrouble : public testing::TestWithParam<const char*> {
 protected:
  optimize::MatchOptions options() const {
    return {.method = GetParam(), .max_evaluations = 300};
  }
};

TEST_P(MatchTrouble, StepsBackFromARegionThatFails) {
  // Gauss-Newton's first step from 0 lands at 8, beyond the edge at 5; the
  // answer is at 4.
  int failed = 0;
  const auto function = [&failed](const VectorX& x) {
    if (x[0] > 5.0) {
      ++failed;
      return pinched();
    }
    return answer_of((x[0] - 4.0) * (0.5 + x[0] / 8.0));
  };
  testing::internal::CaptureStderr();
  const optimize::MatchReport report =
      optimize::match(kUnit, function, options());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.best[0], 4.0, 2e-3);
  EXPECT_EQ(report.failed_evaluations, failed);
}

TEST_P(MatchTrouble, StepsBackFromNaN) {
  const auto function = [](const VectorX& x) {
    return answer_of(x[0] > 5.0 ? kNaN : (x[0] - 4.0) * (0.5 + x[0] / 8.0));
  };
  const optimize::MatchReport report =
      optimize::match(kUnit, function, options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
}

TEST_P(MatchTrouble, AFailingStartIsLeft) {
  const auto function = [](const VectorX& x) {
    return x[0] < 1.0 ? pinched() : answer_of(x[0] - 4.0);
  };
  const optimize::MatchReport report =
      optimize::match(kUnit, function, options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_GE(report.failed_evaluations, 1);
}

TEST_P(MatchTrouble, EveryPointInfeasibleSaysWhatToChange) {
  const optimize::MatchReport report = optimize::match(
      kUnit, [](const VectorX&) { return pinched(); }, options());
  EXPECT_EQ(report.termination, optimize::Termination::NoFeasible);
  EXPECT_EQ(report.best.size(), 0);
  EXPECT_EQ(report.failed_evaluations, report.evaluations);
  EXPECT_LE(report.evaluations, 20);
  EXPECT_THAT(report.message,
              AllOf(HasSubstr("film_pinched"), HasSubstr("the neck closes"),
                    HasSubstr("width = 0"), HasSubstr("bounds")));
}

TEST_P(MatchTrouble, AllNaNIsNoFeasible) {
  const optimize::MatchReport report = optimize::match(
      kUnit, [](const VectorX&) { return answer_of(kNaN); }, options());
  EXPECT_EQ(report.termination, optimize::Termination::NoFeasible);
  EXPECT_THAT(report.message, HasSubstr("not_a_number"));
}

TEST_P(MatchTrouble, AConstantFunctionSaysSo) {
  const optimize::MatchReport report = optimize::match(
      kUnit, [](const VectorX&) { return answer_of(0.4); }, options());
  EXPECT_EQ(report.termination, optimize::Termination::Constant);
  EXPECT_EQ(report.answer.residuals[0], 0.4);
  EXPECT_THAT(report.message, HasSubstr("does not change"));
}

TEST_P(MatchTrouble, WhatTheFunctionThrowsArrives) {
  int calls = 0;
  const auto function = [&calls](const VectorX& x) -> optimize::ResidualAnswer {
    if (++calls == 3) {
      throw IoError("disk full");
    }
    return answer_of((x[0] - 4.0) * (0.5 + x[0] / 8.0));
  };
  EXPECT_THROW(optimize::match(kUnit, function, options()), IoError);
  EXPECT_EQ(calls, 3);
}

TEST_P(MatchTrouble, StopsOnRequest) {
  struct StopAfter : Monitor {
    int* calls = nullptr;
    bool stop_requested() const override { return *calls >= 2; }
  };
  int calls = 0;
  StopAfter monitor;
  monitor.calls = &calls;
  optimize::MatchOptions with_monitor = options();
  with_monitor.monitor = &monitor;
  const auto function = [&calls](const VectorX& x) {
    ++calls;
    return answer_of((x[0] - 4.0) * (0.5 + x[0] / 8.0));
  };
  EXPECT_THROW(optimize::match(kUnit, function, with_monitor), Interrupted);
  EXPECT_EQ(calls, 2);
}

TEST_P(MatchTrouble, KeepsTheIncumbentAtTheEvaluationLimit) {
  double best = std::numeric_limits<double>::infinity();
  int calls = 0;
  const auto function = [&](const VectorX& x) {
    ++calls;
    const double residual = 1.0 + std::abs(x[0] - 7.3);
    best = std::min(best, residual);
    return answer_of(residual);
  };
  optimize::MatchOptions limited = options();
  limited.max_evaluations = 7;
  const optimize::MatchReport report =
      optimize::match(kUnit, function, limited);
  EXPECT_LE(calls, 7);
  EXPECT_EQ(report.answer.residuals[0], best);
  if (calls == 7) {
    EXPECT_EQ(report.termination, optimize::Termination::LimitReached);
    EXPECT_THAT(report.message, HasSubstr("limit of 7 evaluations"));
  }
}

TEST_P(MatchTrouble, OneEvaluationIsEnoughForAnAnswer) {
  optimize::MatchOptions limited = options();
  limited.max_evaluations = 1;
  const optimize::MatchReport report = optimize::match(
      kUnit, [](const VectorX& x) { return answer_of(x[0] - 4.0); }, limited);
  EXPECT_EQ(report.termination, optimize::Termination::LimitReached);
  EXPECT_EQ(report.best[0], 0.0);
}

TEST_P(MatchTrouble, TheTimeLimitHolds) {
  optimize::MatchOptions limited = options();
  limited.time_limit = 1e-9;
  int calls = 0;
  const auto function = [&calls](const VectorX& x) {
    ++calls;
    return answer_of(x[0] - 4.0);
  };
  const optimize::MatchReport report =
      optimize::match(kUnit, function, limited);
  EXPECT_EQ(report.termination, optimize::Termination::LimitReached);
  EXPECT_THAT(report.message, HasSubstr("time limit"));
  EXPECT_EQ(calls, 1);
}

TEST_P(MatchTrouble, EqualBoundsHoldAVariable) {
  const std::vector<optimize::Variable> variables = {{"held", 3.0, 3.0, 3.0},
                                                     {"free", 0.0, 0.0, 10.0}};
  const optimize::MatchReport report = optimize::match(
      variables,
      [](const VectorX& x) {
        EXPECT_EQ(x[0], 3.0);
        return answer_of((x[0] + x[1] - 7.0) * (0.5 + x[1] / 8.0));
      },
      options());
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.best[1], 4.0, 2e-3);
}

TEST_P(MatchTrouble, AllBoundsEqualSaysWhatToChange) {
  const optimize::MatchReport report = optimize::match(
      {{"w", 1.0, 1.0, 1.0}}, [](const VectorX& x) { return answer_of(x[0]); },
      options());
  EXPECT_EQ(report.termination, optimize::Termination::NoFreedom);
  EXPECT_EQ(report.evaluations, 1);
  EXPECT_EQ(report.best[0], 1.0);
  EXPECT_THAT(report.message, AllOf(HasSubstr("'w'"), HasSubstr("Widen")));
}

INSTANTIATE_TEST_SUITE_P(Methods, MatchTrouble,
                         testing::Values("ceres", "bobyqa", "cobyla", "sbplx",
                                         "neldermead", "direct_l"));

TEST(MatchInput, RefusesWhatCannotWork) {
  EXPECT_THAT(refusal({}, {}), HasSubstr("no design variable"));
  EXPECT_THAT(refusal({{"w", 1, 2, 1}}, {}), HasSubstr("swap"));
  EXPECT_THAT(refusal({{"w", 3, 1, 2}}, {}), HasSubstr("outside the bounds"));
  EXPECT_THAT(refusal({{"w", kNaN, 1, 2}}, {}), HasSubstr("finite"));
  EXPECT_THAT(refusal(kUnit, {.method = "newton"}),
              AllOf(HasSubstr("'newton'"), HasSubstr("ceres"),
                    HasSubstr("bobyqa"), HasSubstr("direct_l")));
  EXPECT_THAT(refusal(kUnit, {.tolerance = 0.0}), HasSubstr("tolerance"));
  EXPECT_THAT(refusal(kUnit, {.max_evaluations = 0}), HasSubstr("at least 1"));
  EXPECT_THAT(refusal(kUnit, {.difference_step = 0.0}),
              HasSubstr("difference_step"));
}

TEST(MatchInput, RefusesAnswersThatChangeSize) {
  int calls = 0;
  const auto function = [&calls](const VectorX&) {
    optimize::ResidualAnswer answer;
    answer.residuals = VectorX::Ones(++calls);
    answer.mismatch = answer.residuals;
    return answer;
  };
  EXPECT_THROW(optimize::match(kUnit, function, {}), InvalidInput);
}

TEST(MatchPhases, AreAnnounced) {
  std::string phases;
  optimize::MatchOptions options;
  options.announce = [&phases](optimize::EvaluationPhase phase) {
    phases += std::string(optimize::name_of(phase)) + " ";
  };
  optimize::match(
      {{"w", 0.5, 0.0, 10.0}},
      [](const VectorX& x) {
        return x[0] < 1.0 ? pinched() : answer_of(x[0] - 4.0);
      },
      options);
  EXPECT_EQ(phases, "start probe difference step ");
}

TEST(MatchDifferences, UseTheOtherSideWhenANeighbourFails) {
  const auto function = [](const VectorX& x) {
    return x[0] > 5.0 ? pinched() : answer_of(x[0] - 2.0);
  };
  const optimize::MatchReport report =
      optimize::match({{"w", 5.0, 0.0, 10.0}}, function, {});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_EQ(report.evaluations, 4);
  EXPECT_EQ(report.failed_evaluations, 1);
}

}  // namespace
}  // namespace meniscus::match_trouble_test
