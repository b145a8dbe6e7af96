#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "optimize/problem.h"

namespace meniscus::match_test {
namespace {

using testing::HasSubstr;

// Answers r as residuals and |r| as mismatch, and remembers every point.
struct Recorder {
  std::function<VectorX(const VectorX&)> residuals;
  std::vector<VectorX> points;

  optimize::ResidualFunction function() {
    return [this](const VectorX& x) {
      points.push_back(x);
      optimize::ResidualAnswer answer;
      answer.residuals = residuals(x);
      answer.mismatch = answer.residuals.cwiseAbs();
      return answer;
    };
  }
};

VectorX one(double value) { return VectorX::Constant(1, value); }
VectorX two(double a, double b) {
  VectorX values(2);
  values << a, b;
  return values;
}

// The shape of the two-arm bracket's residual: two deflections that fall and
// rise smoothly with the support's position, mismatch relative to their mean.
double bracket_mismatch(double x, double left, double right) {
  const double a = left * (1.0 + x / 150.0 + x * x / 40000.0);
  const double b = right * (1.0 - x / 150.0 + x * x / 40000.0);
  return (a - b) / (0.5 * (std::abs(a) + std::abs(b)));
}

const std::vector<optimize::Variable> kSupport = {
    {"support_x", 0.0, -40.0, 40.0}};
const std::vector<optimize::Variable> kRosenbrock = {{"x", -1.2, -2.0, 2.0},
                                                     {"y", 1.0, -2.0, 2.0}};

VectorX rosenbrock(const VectorX& x) {
  return two(10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]);
}

TEST(Match, BracketConvergesInFewEvaluations) {
  for (const double right : {1.29, 1.5, 1.55, 0.67}) {
    Recorder recorder{[right](const VectorX& x) {
                        return one(bracket_mismatch(x[0], 1.0, right));
                      },
                      {}};
    const double before = std::abs(bracket_mismatch(0.0, 1.0, right));
    ASSERT_GT(before, 0.25);
    const optimize::MatchReport report =
        optimize::match(kSupport, recorder.function(), {});
    EXPECT_EQ(report.termination, optimize::Termination::Converged)
        << report.message;
    EXPECT_LE(report.answer.mismatch[0], 1e-3);
    EXPECT_LE(report.evaluations, 4) << right;
    EXPECT_EQ(report.evaluations, static_cast<int>(recorder.points.size()));
    EXPECT_THAT(report.message, HasSubstr("support_x = "));
  }
}

TEST(Match, EqualLoadsAreMatchedAtTheStart) {
  Recorder recorder{
      [](const VectorX& x) { return one(bracket_mismatch(x[0], 1.0, 1.0)); },
      {}};
  const optimize::MatchReport report =
      optimize::match(kSupport, recorder.function(), {});
  EXPECT_EQ(report.termination, optimize::Termination::Converged);
  EXPECT_EQ(report.evaluations, 1);
  EXPECT_EQ(report.best[0], 0.0);
}

TEST(Match, LinearResidualsTakeOneStep) {
  Eigen::Matrix3d matrix;
  matrix << 4, 1, 0, 1, 3, -1, 0, 2, 5;
  const Eigen::Vector3d solution(0.3, -0.4, 0.7);
  Recorder recorder{
      [&](const VectorX& x) -> VectorX { return matrix * (x - solution); }, {}};
  const std::vector<optimize::Variable> variables = {
      {"a", 0, -1, 1}, {"b", 0, -1, 1}, {"c", 0, -1, 1}};
  // Forward differences of a linear map err by rounding / step only.
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(), {.tolerance = 1e-7});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_EQ(report.evaluations, 1 + 3 + 1);
  EXPECT_LT((report.best - solution).norm(), 1e-7);
  EXPECT_LT((report.jacobian - matrix).norm(), 1e-9);
}

TEST(Match, UsesTheFunctionsOwnJacobian) {
  int calls = 0;
  const auto function = [&calls](const VectorX& x) {
    ++calls;
    optimize::ResidualAnswer answer;
    answer.residuals = rosenbrock(x);
    answer.mismatch = answer.residuals.cwiseAbs();
    answer.jacobian = Eigen::MatrixXd(2, 2);
    *answer.jacobian << -20.0 * x[0], 10.0, -1.0, 0.0;
    return answer;
  };
  const optimize::MatchReport report =
      optimize::match(kRosenbrock, function, {.tolerance = 1e-9});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_LT((report.best - two(1, 1)).norm(), 1e-8);
  EXPECT_LE(calls, 40);
}

class EveryMethod : public testing::TestWithParam<const char*> {};

TEST_P(EveryMethod, FindsRosenbrocksMinimum) {
  Recorder recorder{rosenbrock, {}};
  const optimize::MatchReport report = optimize::match(
      kRosenbrock, recorder.function(),
      {.method = GetParam(), .tolerance = 1e-3, .max_evaluations = 20000});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_LT((report.best - two(1, 1)).cwiseAbs().maxCoeff(), 4e-3);
}

TEST_P(EveryMethod, AsksTheSamePointsTwiceOverAndNoneTwice) {
  Recorder first{rosenbrock, {}};
  Recorder second{rosenbrock, {}};
  const optimize::MatchOptions options{.method = GetParam(),
                                       .max_evaluations = 60};
  const optimize::MatchReport a =
      optimize::match(kRosenbrock, first.function(), options);
  const optimize::MatchReport b =
      optimize::match(kRosenbrock, second.function(), options);
  EXPECT_EQ(first.points, second.points);  // bit for bit
  EXPECT_EQ(a.best, b.best);
  EXPECT_EQ(a.message, b.message);
  for (std::size_t i = 0; i < first.points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NE(first.points[i], first.points[j]) << i << " " << j;
    }
  }
}

TEST_P(EveryMethod, StaysInsideTheBoundsAndNamesTheOneReached) {
  Recorder recorder{[](const VectorX& x) { return two(x[0] - 5.0, x[1]); }, {}};
  const std::vector<optimize::Variable> variables = {{"reach", 1.0, 0.0, 3.0},
                                                     {"other", 0.4, -1.0, 1.0}};
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(),
                      {.method = GetParam(), .max_evaluations = 3000});
  for (const VectorX& x : recorder.points) {
    EXPECT_TRUE(x[0] >= 0.0 && x[0] <= 3.0 && x[1] >= -1.0 && x[1] <= 1.0);
  }
  if (GetParam() == std::string("direct_l")) {
    return;  // it samples centres of boxes and never stands on a bound
  }
  EXPECT_EQ(report.termination, optimize::Termination::AtBound)
      << report.message;
  EXPECT_EQ(report.best[0], 3.0);
  EXPECT_NEAR(report.best[1], 0.0, 1e-3);
  EXPECT_THAT(report.message, HasSubstr("reach at its upper bound 3"));
  EXPECT_THAT(report.message, HasSubstr("Widen"));
}

TEST_P(EveryMethod, ReachesTheSameAnswerInOneDimension) {
  // 1.55: near a bound, where a simplex can collapse
  const auto function = [](const VectorX& x) {
    return one(bracket_mismatch(x[0], 1.0, 1.55));
  };
  Recorder reference{function, {}};
  Recorder recorder{function, {}};
  const optimize::MatchOptions options{.method = GetParam(), .tolerance = 1e-6};
  const optimize::MatchReport expected =
      optimize::match(kSupport, reference.function(), {.tolerance = 1e-9});
  const optimize::MatchReport report =
      optimize::match(kSupport, recorder.function(), options);
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  // mismatch per mm is about 1/75 there
  EXPECT_NEAR(report.best[0], expected.best[0], 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values("ceres", "bobyqa", "cobyla", "sbplx",
                                         "neldermead", "direct_l"));

TEST(Match, MessagesNameAGroupOfVariablesOnce) {
  // x_k wants to be at 1.2 k, from 0 to 7.2, and may be from 1 to 3.
  Recorder recorder{[](const VectorX& x) -> VectorX {
                      return x - VectorX::LinSpaced(7, 0.0, 7.2);
                    },
                    {}};
  std::vector<optimize::Variable> variables;
  for (int k = 0; k < 7; ++k) {
    variables.push_back({.name = "t[" + std::to_string(k + 1) + "]",
                         .initial = 2.0,
                         .lower = 1.0,
                         .upper = 3.0,
                         .group = k < 6 ? "t" : ""});
  }
  variables[6].name = "alone";
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(), {});
  EXPECT_EQ(report.termination, optimize::Termination::AtBound);
  EXPECT_THAT(
      report.message,
      testing::AllOf(HasSubstr("t = 1 to 3, alone = 3"),
                     HasSubstr("1 of 6 elements of t at a lower bound, 3 of 6 "
                               "elements of t at an upper bound, alone at its "
                               "upper bound 3")));
}

TEST(Match, MoreVariablesThanTargetsIsSolved) {
  Recorder recorder{
      [](const VectorX& x) { return one(x[0] + 2.0 * x[1] - 1.0); }, {}};
  const std::vector<optimize::Variable> variables = {{"a", 0, -1, 1},
                                                     {"b", 0, -1, 1}};
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(), {.tolerance = 1e-8});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
}

TEST(Match, RankOneUpdatesSaveDifferences) {
  const int n = 10;
  Recorder recorder{[n](const VectorX& x) -> VectorX {
                      VectorX r(n);
                      for (int i = 0; i < n; ++i) {
                        r[i] = x[i] + 0.1 * x[(i + 1) % n] * x[i] - 0.5;
                      }
                      return r;
                    },
                    {}};
  std::vector<optimize::Variable> variables;
  variables.reserve(n);
  for (int i = 0; i < n; ++i) {
    variables.push_back({fmt::format("v{}", i), 0.0, -1.0, 1.0});
  }
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(), {.tolerance = 1e-6});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  // One Jacobian by differences costs 10; fresh ones each step would need 4.
  EXPECT_LE(report.evaluations, 1 + n + 10);
}

TEST(Match, StartOnTheUpperBoundDifferencesInwards) {
  Recorder recorder{[](const VectorX& x) { return one(x[0] - 0.25); }, {}};
  const optimize::MatchReport report =
      optimize::match({{"x", 1.0, 0.0, 1.0}}, recorder.function(), {});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_EQ(recorder.points[1][0], 1.0 - 1e-3);
}

TEST(Match, AMinimumThatMissesTheToleranceIsStalled) {
  Recorder recorder{[](const VectorX& x) { return two(x[0] - 1.0, x[0] + 1); },
                    {}};
  const optimize::MatchReport report =
      optimize::match({{"x", 0.5, -3.0, 3.0}}, recorder.function(), {});
  EXPECT_EQ(report.termination, optimize::Termination::Stalled)
      << report.message;
  EXPECT_NEAR(report.best[0], 0.0, 1e-6);
  EXPECT_LE(report.evaluations, 12);
}

TEST(Match, AValleyThatMissesTheTargetEndsSoon) {
  // |r| is least, and not 0, at 0.31: there is nothing to be found below.
  const std::vector<optimize::Variable> variables = {
      {.name = "x", .initial = 0.0, .lower = -1.0, .upper = 1.0}};
  const optimize::MatchReport report = optimize::match(
      variables,
      [](const VectorX& x) {
        const VectorX r = VectorX::Constant(1, 0.1 + std::pow(x[0] - 0.31, 2));
        return optimize::ResidualAnswer{.residuals = r,
                                        .mismatch = r.cwiseAbs()};
      },
      {.method = "ceres", .tolerance = 1e-3, .max_evaluations = 100});
  EXPECT_EQ(report.termination, optimize::Termination::Stalled)
      << report.message;
  EXPECT_LT(report.evaluations, 50);
  EXPECT_NEAR(report.best[0], 0.31, 0.01);
}

// The residuals of three targets in two variables, and their Jacobian.
VectorX three_targets(const VectorX& x) {
  VectorX r(3);
  r << std::exp(x[0]) - 2.0, x[0] * x[1] - std::log(2.0) * 0.5,
      x[1] * x[1] - 0.25;
  return r;
}

optimize::JacobianAnswer three_targets_jacobian(const VectorX& x) {
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << std::exp(x[0]), 0.0, x[1], x[0], 0.0, 2.0 * x[1];
  return {.jacobian = jacobian, .failure = {}};
}

TEST(MatchJacobian, IsAskedOnlyWhereAStepWasAccepted) {
  Recorder recorder{three_targets, {}};
  std::vector<VectorX> asked;
  optimize::MatchOptions options{.tolerance = 1e-10};
  options.jacobian = [&asked](const VectorX& x) {
    asked.push_back(x);
    return three_targets_jacobian(x);
  };
  const std::vector<optimize::Variable> variables = {{"a", 0.2, -1, 1},
                                                     {"b", 1, 0, 2}};
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(), options);
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  EXPECT_NEAR(report.best[0], std::log(2.0), 1e-9);
  EXPECT_NEAR(report.best[1], 0.5, 1e-9);
  EXPECT_EQ(report.gradient_evaluations, static_cast<int>(asked.size()));
  // Gauss-Newton converges quadratically: no neighbours, no long tail.
  EXPECT_LE(report.evaluations, 8);
  EXPECT_LT(asked.size(), recorder.points.size());
  EXPECT_NE(asked.back(), recorder.points.back());  // the answer needs none
}

TEST(MatchJacobian, OneThatFailsIsReplacedByDifferences) {
  Recorder recorder{three_targets, {}};
  optimize::MatchOptions options{.tolerance = 1e-6};
  options.jacobian = [](const VectorX&) {
    return optimize::JacobianAnswer{
        .jacobian = {}, .failure = Failure{FailureKind::SolverFailed, "dual"}};
  };
  const std::vector<optimize::Variable> variables = {{"a", 0.2, -1, 1},
                                                     {"b", 1, 0, 2}};
  const optimize::MatchReport report =
      optimize::match(variables, recorder.function(), options);
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
}

TEST(MatchJacobian, OfAWrongSizeIsRefused) {
  Recorder recorder{three_targets, {}};
  optimize::MatchOptions options;
  options.jacobian = [](const VectorX&) {
    return optimize::JacobianAnswer{.jacobian = Eigen::MatrixXd::Zero(1, 2),
                                    .failure = {}};
  };
  const std::vector<optimize::Variable> variables = {{"a", 0.2, -1, 1},
                                                     {"b", 1, 0, 2}};
  EXPECT_THROW(optimize::match(variables, recorder.function(), options),
               InvalidInput);
}

TEST(MatchDifferences, AreToldInAdvance) {
  Recorder recorder{three_targets, {}};
  std::vector<VectorX> told;
  optimize::MatchOptions options{.tolerance = 1e-4};
  options.prefetch = [&told](const std::vector<VectorX>& points) {
    told.insert(told.end(), points.begin(), points.end());
  };
  const std::vector<optimize::Variable> variables = {{"a", 0.2, -1, 1},
                                                     {"b", 1, 0, 2}};
  optimize::match(variables, recorder.function(), options);
  ASSERT_GE(told.size(), 2U);
  EXPECT_EQ(told[0], recorder.points[1]);
  EXPECT_EQ(told[1], recorder.points[2]);
}

TEST(MatchMessage, SaysWhenTheToleranceIsBelowTheMeshesError) {
  const auto run = [](double error) {
    Recorder recorder{[](const VectorX& x) { return one(x[0] - 0.25); }, {}};
    optimize::MatchOptions options{.tolerance = 1e-3};
    options.mismatch_error = one(error);
    return optimize::match({{"x", 0.5, 0.0, 1.0}}, recorder.function(), options)
        .message;
  };
  EXPECT_THAT(run(0.02), HasSubstr("below the mesh's own error"));
  EXPECT_THAT(run(1e-4), testing::Not(HasSubstr("mesh")));
}

}  // namespace
}  // namespace meniscus::match_test
