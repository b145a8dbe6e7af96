#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "optimize/minimize.h"
#include "tests/support/standard_problems.h"

namespace meniscus::trust_region_test {
namespace {

using tests::vector_of;

constexpr double kOpen = std::numeric_limits<double>::infinity();

optimize::VectorAnswer no_film() {
  return {.values = {},
          .failure = Failure{FailureKind::FilmPinched, "the neck closes"}};
}

// As a sizing: mass falls along variables that thin the part; it fails where it
// is too thin, and the deflection binds a little before.
struct Sizing {
  int variables = 2;
  double start = 0.95;   // of the ranges: far from the answer
  double beside = 0.02;  // of the range, from the bound to the failures
  std::vector<VectorX> asked = {};

  optimize::MinimizeProblem problem() {
    optimize::MinimizeProblem result;
    for (int j = 0; j < variables; ++j) {
      result.variables.push_back(
          {fmt::format("t{}", j), 1.0 + 9.0 * start, 1.0, 10.0});
    }
    result.objective = "mass";
    result.constraints = {{"deflection", -kOpen, 1.0, {}}};
    result.function = [this](const VectorX& x) -> optimize::VectorAnswer {
      asked.push_back(x);
      if (soft(x) > 1.0 + 9.0 * beside) {
        return no_film();
      }
      return {.values = vector_of({weight().dot(x), soft(x)}), .failure = {}};
    };
    result.jacobian = [this](const VectorX& x) -> optimize::JacobianAnswer {
      Eigen::MatrixXd jacobian(2, x.size());
      jacobian.row(0) = weight().transpose();
      jacobian.row(1) =
          (-3.0 * 27.0 / variables * x.array().pow(-4.0)).matrix().transpose();
      return {.jacobian = jacobian, .failure = {}};
    };
    return result;
  }
  VectorX weight() const { return VectorX::LinSpaced(variables, 1.0, 2.0); }
  // Sum of 27 / (n t^3): 1 at t = 3.
  double soft(const VectorX& x) const {
    return (27.0 / variables * x.array().pow(-3.0)).sum();
  }
  // Lagrange: w = m 81 / (n t^4), so t ~ w^(-1/4).
  double least() const {
    const VectorX shape = weight().array().pow(-0.25);
    return std::cbrt(soft(shape)) * weight().dot(shape);
  }
};

TEST(TrustRegion, AFarStartBesideFailuresEndsAtTheMinimum) {
  for (const int variables : {1, 2, 5, 19}) {
    for (const double beside : {1e-3, 0.02, 0.3}) {
      Sizing sizing{.variables = variables, .beside = beside};
      const optimize::MinimizeReport report =
          optimize::minimize(sizing.problem(), {.optimality_tolerance = 1e-4});
      EXPECT_EQ(report.termination, optimize::Termination::Converged)
          << variables << " " << beside << ": " << report.message;
      EXPECT_NEAR(report.objective / sizing.least(), 1.0, 1e-3);
      // Steps are learnt from what failed: not two fifths of the designs.
      EXPECT_LE(5 * report.failed_evaluations, 2 * report.evaluations)
          << variables << " " << beside;
      EXPECT_LE(report.evaluations, 60);
    }
  }
}

// A design that is another one to seven digits tells nothing new.
TEST(TrustRegion, NoDesignIsAskedForTwiceToSevenDigits) {
  for (const char* method : {"slsqp", "mma", "ccsa"}) {
    Sizing sizing{.variables = 3};
    optimize::minimize(sizing.problem(), {.method = method});
    for (std::size_t i = 0; i < sizing.asked.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT((sizing.asked[i] - sizing.asked[j]).cwiseAbs().maxCoeff(),
                  9.0 * 1e-7)
            << method << " " << i << " " << j;
      }
    }
  }
}

// The wall is all there is: no constraint sees it. Sliding along it, the search
// comes within 2 % of what it allows.
TEST(TrustRegion, SlidesAlongAWallThatOnlyFailuresShow) {
  std::mt19937 draw(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 20; ++round) {
    const VectorX normal =
        vector_of({0.3 + unit(draw), 0.3 + unit(draw)}).normalized();
    const VectorX target = vector_of({0.6 + 0.3 * unit(draw), 0.9});
    const double reach = 0.7 * normal.dot(target);
    optimize::MinimizeProblem problem;
    problem.variables = {{"a", 0.1, 0.0, 1.0}, {"b", 0.1, 0.0, 1.0}};
    problem.objective = "distance";
    problem.function = [&](const VectorX& x) -> optimize::VectorAnswer {
      return normal.dot(x) > reach
                 ? no_film()
                 : optimize::VectorAnswer{
                       .values = vector_of({1.0 + (x - target).squaredNorm()}),
                       .failure = {}};
    };
    problem.jacobian = [&](const VectorX& x) -> optimize::JacobianAnswer {
      return {.jacobian = 2.0 * (x - target).transpose(), .failure = {}};
    };
    const double least = 1.0 + std::pow(normal.dot(target) - reach, 2);
    const optimize::MinimizeReport report = optimize::minimize(problem);
    EXPECT_LT(report.objective, 1.02 * least)
        << round << ": " << report.message;
  }
}

// A margin to collapse falls like a root towards the fold, beyond which nothing
// answers: told so, the search asks for fewer designs that have none.
TEST(TrustRegion, ARootIsFollowedByItsSquare) {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int plain_failed = 0;
  int failed = 0;
  for (int round = 0; round < 20; ++round) {
    const VectorX normal =
        vector_of({0.3 + unit(draw), 0.3 + unit(draw), 0.3 + unit(draw)})
            .normalized();
    const double fold = 0.3 + 0.2 * unit(draw);
    const double bound = 0.05 + 0.1 * unit(draw);
    const auto height = [&](const VectorX& x) {
      return normal.dot(x) + 0.2 * x.squaredNorm() - fold;
    };
    optimize::MinimizeProblem problem;
    problem.variables = {
        {"a", 0.9, 0.0, 1.0}, {"b", 0.9, 0.0, 1.0}, {"c", 0.9, 0.0, 1.0}};
    problem.objective = "mass";
    problem.function = [&](const VectorX& x) -> optimize::VectorAnswer {
      if (!(height(x) > 0.0)) {
        return no_film();
      }
      return {.values = vector_of({1.0 + x.sum(), std::sqrt(height(x))}),
              .failure = {}};
    };
    problem.jacobian = [&](const VectorX& x) -> optimize::JacobianAnswer {
      Eigen::MatrixXd jacobian(2, 3);
      jacobian.row(0).setOnes();
      jacobian.row(1) =
          (normal + 0.4 * x).transpose() / (2.0 * std::sqrt(height(x)));
      return {.jacobian = jacobian, .failure = {}};
    };
    double least = 0.0;
    for (const bool root_like : {false, true}) {
      problem.constraints = {{"margin", bound, kOpen, {}, root_like}};
      const optimize::MinimizeReport report =
          optimize::minimize(problem, {.optimality_tolerance = 1e-6});
      EXPECT_TRUE(report.feasible) << report.message;
      (root_like ? failed : plain_failed) += report.failed_evaluations;
      if (root_like) {
        EXPECT_EQ(report.termination, optimize::Termination::Converged)
            << round << ": " << report.message;
        EXPECT_NEAR(report.values[1], bound, 1e-3 * bound);
        EXPECT_LE(report.objective, least * (1.0 + 1e-4)) << round;
      }
      least = report.objective;
    }
  }
  EXPECT_LT(2 * failed, plain_failed) << failed << " of " << plain_failed;
}

// Held near to its start a search ends at the best design there, and judges it
// in the units of the whole ranges.
TEST(TrustRegion, AHeldSearchStaysAndConverges) {
  Sizing sizing{.variables = 3, .start = 0.5};
  optimize::MinimizeProblem problem = sizing.problem();
  for (optimize::Variable& v : problem.variables) {
    v.range = v.upper - v.lower;
    v.lower = v.initial - 0.03 * *v.range;
    v.upper = v.initial + 0.03 * *v.range;
  }
  const optimize::MinimizeReport report =
      optimize::minimize(problem, {.optimality_tolerance = 1e-4});
  EXPECT_EQ(report.termination, optimize::Termination::Converged)
      << report.message;
  for (Eigen::Index j = 0; j < report.best.size(); ++j) {
    EXPECT_EQ(report.best[j],
              problem.variables[static_cast<std::size_t>(j)].lower);
  }
  // What a bound costs does not depend on how near the others are.
  ASSERT_TRUE(report.first_order);
  EXPECT_NEAR(report.first_order->bound_multipliers[0], -1.0, 1e-3);
}

// The answer is the best of the designs that were asked for, in the order that
// the log tells them by.
TEST(TrustRegion, TheAnswerIsTheBestThatWasTold) {
  for (const tests::StandardProblem& known : tests::standard_problems()) {
    optimize::MinimizeProblem problem = known.problem;
    std::vector<VectorX> values;
    problem.function = [&](const VectorX& x) {
      optimize::VectorAnswer answer = known.problem.function(x);
      values.push_back(answer.values);
      return answer;
    };
    const optimize::MinimizeReport report = optimize::minimize(problem);
    const auto violation = [&](const VectorX& v) {
      double worst = 0.0;
      for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
        const optimize::ResponseBounds& bounds = problem.constraints[k];
        const double g = v[static_cast<Eigen::Index>(k) + 1];
        double scale = 0.0;
        for (const double bound : {bounds.lower, bounds.upper}) {
          scale =
              std::isfinite(bound) ? std::max(scale, std::abs(bound)) : scale;
        }
        worst = std::max({worst, (g - bounds.upper) / (scale > 0 ? scale : 1),
                          (bounds.lower - g) / (scale > 0 ? scale : 1)});
      }
      return worst;
    };
    const double answer =
        optimize::kept_objective(report.objective, violation(report.values));
    for (const VectorX& v : values) {
      if (violation(v) <= 1e-6) {
        EXPECT_LE(answer, optimize::kept_objective(v[0], violation(v)) +
                              1e-4 * std::abs(report.objective))
            << known.name;
      }
    }
  }
}

}  // namespace
}  // namespace meniscus::trust_region_test
