#include "optimize/check_gradient.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include <gmock/gmock.h>

namespace meniscus::check_gradient_test {
namespace {

using testing::HasSubstr;

const std::vector<optimize::Variable> kVariables = {{"a", 0.7, 0.0, 2.0},
                                                    {"b", 1.0, -1.0, 1.0}};
const std::vector<std::string> kResponses = {"wave", "product"};

optimize::VectorAnswer evaluate(const VectorX& x) {
  optimize::VectorAnswer answer;
  answer.values.resize(2);
  answer.values << std::sin(x[0]) + std::exp(x[1]), x[0] * x[1];
  return answer;
}

Eigen::MatrixXd exact() {
  Eigen::MatrixXd jacobian(2, 2);
  jacobian << std::cos(0.7), std::exp(1.0), 1.0, 0.7;
  return jacobian;
}

TEST(CheckGradient, PassesTheExactOneAlsoAtABound) {
  const optimize::GradientCheckReport report =
      optimize::check_gradient(kVariables, kResponses, evaluate, exact());
  EXPECT_TRUE(report.passed) << report.message;
  ASSERT_EQ(report.rows.size(), 4U);
  EXPECT_EQ(report.rows[1].response, "wave");
  EXPECT_EQ(report.rows[1].variable, "b");
  // Two steps of a smooth function agree; no more are tried.
  EXPECT_EQ(report.evaluations, 1 + 2 * 2 * 2);
  // Rounding of a second difference at the best step, with a wide margin.
  EXPECT_LT(report.rows[1].error, 1e-8);
}

TEST(CheckGradient, NamesTheWrongOne) {
  Eigen::MatrixXd wrong = exact();
  wrong(1, 0) *= 1.0 + 1e-3;
  const optimize::GradientCheckReport report =
      optimize::check_gradient(kVariables, kResponses, evaluate, wrong);
  EXPECT_FALSE(report.passed);
  EXPECT_FALSE(report.rows[2].passed);
  EXPECT_TRUE(report.rows[0].passed);
  EXPECT_THAT(report.message, HasSubstr("d product / d a"));
}

/// As distances to a scan have them: a slope that jumps 5e-5 beside the design,
/// and a function of some noise. Large steps agree on a slope half the jump off
/// and better than small ones do.
TEST(CheckGradient, AKinkNearbyDoesNotCondemnTheRightOne) {
  constexpr double kJump = 4e-5;
  constexpr double kNoise = 3e-12;
  const auto bent = [](const VectorX& x) {
    optimize::VectorAnswer answer;
    const double t = x[0] - 0.5;
    answer.values = VectorX::Constant(
        1, t + kJump * std::max(0.0, t - 5e-5) + kNoise * std::sin(1e7 * t));
    return answer;
  };
  const auto check = [&](double given) {
    return optimize::check_gradient({{"a", 0.5, 0.0, 1.0}}, {"bent"}, bent,
                                    Eigen::MatrixXd::Constant(1, 1, given),
                                    {.tolerance = 5e-6})
        .passed;
  };
  EXPECT_TRUE(check(1.0));
  EXPECT_FALSE(check(1.0 + 0.5 * kJump));
  EXPECT_FALSE(check(1.0 + kJump));
}

/// As the mean distance of thousands of vertices to a rough scan has it: a kink
/// every 3e-5 of the range, the first 2e-6 beside the design, so that no two of
/// the usual steps agree.
TEST(CheckGradient, SmallerStepsAreTriedAmongManyKinks) {
  constexpr double kSpacing = 3e-5;
  constexpr double kJump = 1e-3;
  const auto rough = [](const VectorX& x) {
    optimize::VectorAnswer answer;
    const double t = x[0] - 0.5;
    double value = t;
    for (int k = 0; k < 400; ++k) {
      value += kJump * std::max(0.0, t - 2e-6 - k * kSpacing);
    }
    answer.values = VectorX::Constant(1, value);
    return answer;
  };
  const auto check = [&](double given, std::vector<double> finer) {
    return optimize::check_gradient({{"a", 0.5, 0.0, 1.0}}, {"rough"}, rough,
                                    Eigen::MatrixXd::Constant(1, 1, given),
                                    {.finer_steps = std::move(finer)})
        .passed;
  };
  const std::vector<double> finer =
      optimize::GradientCheckOptions{}.finer_steps;
  EXPECT_FALSE(check(1.0, {}));
  EXPECT_TRUE(check(1.0, finer));
  EXPECT_FALSE(check(1.0 + 0.5 * kJump, finer));
}

/// Values of nine decimals: the smallest steps see slopes 1e-5 off.
TEST(CheckGradient, LargerStepsAreTriedWhereSmallOnesSeeRounding) {
  const auto rounded = [](const VectorX& x) {
    optimize::VectorAnswer answer = evaluate(x);
    answer.values = (1e9 * answer.values).array().round() / 1e9;
    return answer;
  };
  const optimize::GradientCheckReport report =
      optimize::check_gradient(kVariables, kResponses, rounded, exact());
  EXPECT_TRUE(report.passed) << report.message;
  EXPECT_GT(report.rows[0].step, 5e-5);  // of 2e-5 at least
  EXPECT_GT(report.evaluations, 1 + 2 * 2 * 2);
  EXPECT_LT(report.evaluations, 1 + 2 * 2 * 7);
}

/// As a film solved to 1e-10 of its deflection has it: a thousand functions of
/// strong curvature, each of its own noise. Two of the smallest steps agree by
/// chance now and then, and must not be believed over larger ones.
TEST(CheckGradient, SmallStepsDoNotAgreeByChance) {
  constexpr double kSlope = -13.0;
  constexpr double kNoise = 1e-9;  // 1e-10 of the value
  constexpr int kFunctions = 1000;
  int right_refused = 0;
  int wrong_passed = 0;
  for (int seed = 0; seed < kFunctions; ++seed) {
    const auto noisy = [&](const VectorX& x) {
      std::mt19937_64 random(std::bit_cast<std::uint64_t>(x[0]) + seed);
      const double t = x[0] - 0.5;
      optimize::VectorAnswer answer;
      answer.values = VectorX::Constant(
          1, 6.4 + kSlope * t + 104.0 * t * t - 150.0 * t * t * t +
                 std::uniform_real_distribution<>(-kNoise, kNoise)(random));
      return answer;
    };
    const auto passes = [&](double given) {
      return optimize::check_gradient({{"a", 0.5, 0.1, 0.9}}, {"noisy"}, noisy,
                                      Eigen::MatrixXd::Constant(1, 1, given))
          .passed;
    };
    right_refused += passes(kSlope) ? 0 : 1;
    wrong_passed += passes(kSlope * (1.0 + 4e-5)) ? 1 : 0;
  }
  EXPECT_EQ(right_refused, 0);
  EXPECT_EQ(wrong_passed, 0);
}

TEST(CheckGradient, NeighboursThatFailDoNotPass) {
  const auto function = [](const VectorX& x) {
    optimize::VectorAnswer answer = evaluate(x);
    if (x[0] != 0.7) {
      answer.failure = Failure{FailureKind::FilmPinched, "neck"};
    }
    return answer;
  };
  const optimize::GradientCheckReport report =
      optimize::check_gradient(kVariables, kResponses, function, exact());
  EXPECT_FALSE(report.rows[0].passed);
  EXPECT_TRUE(std::isnan(report.rows[0].difference));
  EXPECT_TRUE(report.rows[1].passed);
}

TEST(CheckGradient, RefusesWrongSizesAndFailingCentre) {
  EXPECT_THROW(optimize::check_gradient(kVariables, kResponses, evaluate,
                                        Eigen::MatrixXd(1, 2)),
               InvalidInput);
  EXPECT_THROW(optimize::check_gradient(kVariables, kResponses, evaluate,
                                        exact(), {.steps = {1e-3}}),
               InvalidInput);
  const auto failing = [](const VectorX&) {
    optimize::VectorAnswer answer;
    answer.failure = Failure{FailureKind::FilmPinched, "neck"};
    return answer;
  };
  EXPECT_THROW(
      optimize::check_gradient(kVariables, kResponses, failing, exact()),
      InvalidInput);
}

}  // namespace
}  // namespace meniscus::check_gradient_test
