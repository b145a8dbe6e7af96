/// The project's main job, as its users would check it: cases/two_arm at sizes
/// that a test can afford.
#include <cmath>
#include <filesystem>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "pipeline/forward/forward_model.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/study/study.h"
#include "tests/support/temp_folder.h"

namespace meniscus::two_arm_test {
namespace {

constexpr const char* kCase = MENISCUS_SOURCE_DIR "/cases/two_arm/case.toml";
constexpr double kSymmetry = 0.5;  // mm; what the issue of the case allows

case_data::Case two_arm(std::vector<std::string> overrides) {
  for (const char* edge : {"resolution.fea=16", "resolution.film=8"}) {
    overrides.emplace_back(edge);
  }
  return reader::read_case(kCase, overrides);
}

study::RunResult run(const std::vector<std::string>& overrides) {
  const TempFolder folder;
  const case_data::Case input = two_arm(overrides);
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  return study::run_study(input, store, {.estimate_errors = false});
}

VectorX at(double support_x) { return VectorX::Constant(1, support_x); }

TEST(TwoArm, MatchesFromAMismatchOfAQuarterTowardsTheHeavierLoad) {
  const study::RunResult result = run({});
  ASSERT_EQ(result.status, study::RunStatus::Converged) << result.message;
  const VectorX& before = result.start->responses;
  EXPECT_GT(std::abs(before[0] - before[1]),
            0.25 * 0.5 * (std::abs(before[0]) + std::abs(before[1])));
  const VectorX& after = result.best->responses;
  EXPECT_LE(std::abs(after[0] - after[1]),
            1e-3 * 0.5 * (std::abs(after[0]) + std::abs(after[1])));
  EXPECT_GT(result.best->design[0], 0.0);  // the right arm carries more
  EXPECT_LT(result.best->design[0], 40.0);
  EXPECT_LE(result.evaluations, 15);
  EXPECT_EQ(result.best->film.index, 0);
  EXPECT_LE(result.best->film.residual, result.best->film.residual_bound);
}

TEST(TwoArm, BobyqaReachesTheAnswerOfCeres) {
  const study::RunResult ceres = run({});
  const study::RunResult bobyqa = run({"study.method=bobyqa"});
  ASSERT_EQ(bobyqa.status, study::RunStatus::Converged) << bobyqa.message;
  EXPECT_NEAR(bobyqa.best->design[0], ceres.best->design[0], kSymmetry);
}

TEST(TwoArm, SwappedLoadsMirrorTheAnswer) {
  const study::RunResult plain = run({"study.tolerance=1e-5"});
  const study::RunResult swapped =
      run({"study.tolerance=1e-5", "load_left=60000", "load_right=40000"});
  ASSERT_EQ(swapped.status, study::RunStatus::Converged) << swapped.message;
  EXPECT_NEAR(swapped.best->design[0], -plain.best->design[0], kSymmetry);
}

TEST(TwoArm, EqualLoadsLeaveTheSupportInTheMiddle) {
  const study::RunResult equal =
      run({"study.tolerance=1e-5", "load_left=50000", "load_right=50000"});
  ASSERT_EQ(equal.status, study::RunStatus::Converged) << equal.message;
  EXPECT_NEAR(equal.best->design[0], 0.0, kSymmetry);
}

/// Largest departure of `values`, at even steps over [-1, 1], from their
/// least-squares polynomial of `degree`.
double departure(const VectorX& values, int degree) {
  Eigen::MatrixXd powers(values.size(), degree + 1);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const double s =
        2.0 * static_cast<double>(k) / static_cast<double>(values.size() - 1) -
        1.0;
    for (int power = 0; power <= degree; ++power) {
      powers(k, power) = std::pow(s, power);
    }
  }
  const VectorX fit = powers * powers.colPivHouseholderQr().solve(values);
  return (fit - values).cwiseAbs().maxCoeff();
}

TEST(TwoArm, TheDesignMapIsSmooth) {
  const forward::ForwardModel model(two_arm({}));
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const VectorX start = model.evaluate(at(0.0)).responses;
  const double at_start = std::pow(start[0] - start[1], 2);
  constexpr double kAnswer = 13.1;  // mm
  constexpr double kWidth = 5.0;    // mm
  constexpr int kSamples = 21;
  VectorX left(kSamples);
  VectorX difference(kSamples);
  for (int k = 0; k < kSamples; ++k) {
    const double x = kAnswer + kWidth * (k / (kSamples - 1.0) - 0.5);
    const forward::Evaluation e = model.evaluate(at(x));
    ASSERT_FALSE(e.failure) << e.failure->message;
    left[k] = e.responses[0];
    difference[k] = e.responses[0] - e.responses[1];
  }
  const VectorX objective = difference.cwiseAbs2();
  // A quartic misses the true fifth order of a smooth function; the objective
  // nearly vanishes here, so its scale is its value at the start.
  constexpr double kQuartic = 1e-7;
  EXPECT_LT(departure(left, 4), kQuartic * left.cwiseAbs().maxCoeff());
  EXPECT_LT(departure(difference, 4),
            kQuartic * difference.cwiseAbs().maxCoeff());
  EXPECT_LT(departure(objective, 4), kQuartic * at_start);
  // What even the eighth degree misses is noise: the solver stops at 1e-10 in
  // the energy norm, and the objective is made of squares of differences.
  constexpr double kNoise = 1e-9;
  EXPECT_LT(departure(objective, 8), kNoise * objective.cwiseAbs().maxCoeff());
}

TEST(TwoArm, EvaluatingABAGivesTheSameBits) {
  const forward::ForwardModel model(two_arm({}));
  const VectorX first = model.evaluate(at(10.0)).responses;
  const VectorX other = model.evaluate(at(-20.0)).responses;
  const VectorX again = model.evaluate(at(10.0)).responses;
  ASSERT_EQ(first.size(), 2);
  EXPECT_TRUE(first == again);
  EXPECT_FALSE(first == other);
}

TEST(TwoArm, TheFilmIsStableOverTheBounds) {
  const forward::ForwardModel model(two_arm({}));
  for (const double x : {-40.0, -20.0, 0.0, 20.0, 40.0}) {
    const forward::Evaluation e = model.evaluate(at(x));
    ASSERT_FALSE(e.failure) << x << ": " << e.failure->message;
    EXPECT_EQ(e.film.index, 0) << x;
    EXPECT_GT(e.film.min_eigenvalue, 0.0) << x;
    EXPECT_LE(e.film.residual, e.film.residual_bound) << x;
    const settle::BodyState& body = e.film.bodies.front();
    EXPECT_NEAR(body.volume, body.target_volume, 1e-10 * body.target_volume);
    EXPECT_LE(e.fea.reaction_imbalance, 1e-9) << x;
  }
}

TEST(TwoArm, TooLittleVolumeFarOutCannotBeEvaluated) {
  const forward::ForwardModel model(two_arm({"bodies.part.volume=1.55e6"}));
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const forward::Evaluation e = model.evaluate(at(40.0));
  ASSERT_TRUE(e.failure);
  EXPECT_TRUE(e.failure->kind == FailureKind::FilmPinched ||
              e.failure->kind == FailureKind::FilmUnstable)
      << e.failure->message;
}

}  // namespace
}  // namespace meniscus::two_arm_test
