/// cases/two_arm_sized on one frozen model: the optimum is the same from two
/// starts, and nothing feasible about it is lighter.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iostream>
#include <optional>

#include <Eigen/QR>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "optimize/minimize.h"
#include "optimize/samples/sampling.h"
#include "pipeline/case_data/studied_responses.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/study/study.h"

namespace meniscus::two_arm_sized_test {
namespace {

constexpr const char* kCase =
    MENISCUS_SOURCE_DIR "/cases/two_arm_sized/case.toml";
constexpr double kOneMass = 1e-3;  // 1e-2 was asked
constexpr double kOptimality = 1e-4;
// Samples lie about the optimum within this part of the ranges, volumes, which
// are the mass, within less: not far below it films collapse.
constexpr double kReach = 0.05;
constexpr double kVolumeReach = 0.02;
constexpr int kVolumes = 3;  // the last variables
constexpr int kSamples = 20;
constexpr int kLighter = 6;  // of them began below the optimum's mass
constexpr int kMostTries = 20;
constexpr int kCorrections = 8;
// What a feasible sample may miss a constraint by [its scale]; the multipliers
// make of it less than the gain below.
constexpr double kMissed = 1e-5;
constexpr double kGain = 1e-4;  // x the mass

// The study's objective and constraints on one model, the last design kept.
class Loop {
 public:
  explicit Loop(const case_data::Case& input)
      : input_(input),
        model_(input),
        rows_(case_data::studied_responses(input)) {}

  bool usable() const { return !model_.failure(); }

  optimize::VectorAnswer values(const VectorX& x) {
    fields_ = {};
    last_ = model_.evaluate(x, &fields_, &adjoint_);
    if (last_.failure) {
      return {.values = {}, .failure = last_.failure};
    }
    return {.values = last_.responses(rows_), .failure = {}};
  }

  optimize::JacobianAnswer jacobian(const VectorX& x) {
    if (last_.design != x) {
      values(x);
    }
    forward::DesignGradient found =
        model_.gradient(last_, fields_, adjoint_, rows_);
    return {.jacobian = std::move(found.jacobian), .failure = found.failure};
  }

  optimize::MinimizeProblem problem() {
    optimize::MinimizeProblem problem;
    for (const case_data::DesignVariable& v : input_.design) {
      problem.variables.push_back({v.name, v.initial, v.lower, v.upper});
    }
    problem.objective = "mass";
    for (const case_data::ConstraintEntry& entry : input_.study.constraints) {
      problem.constraints.push_back(
          {.name = input_.responses[entry.response].name,
           .lower = entry.lower,
           .upper = entry.upper});
    }
    problem.function = [this](const VectorX& x) { return values(x); };
    problem.jacobian = [this](const VectorX& x) { return jacobian(x); };
    return problem;
  }

 private:
  const case_data::Case& input_;
  forward::ForwardModel model_;
  std::vector<int> rows_;
  forward::Evaluation last_;
  forward::EvaluationFields fields_;
  forward::AdjointState adjoint_;
};

VectorX start(std::initializer_list<double> numbers) {
  return Eigen::Map<const VectorX>(numbers.begin(),
                                   static_cast<Eigen::Index>(numbers.size()));
}

optimize::MinimizeReport minimum_from(Loop& loop, const VectorX& x) {
  optimize::MinimizeProblem problem = loop.problem();
  for (std::size_t j = 0; j < problem.variables.size(); ++j) {
    problem.variables[j].initial = x[static_cast<Eigen::Index>(j)];
  }
  return optimize::minimize(problem, {.optimality_tolerance = kOptimality});
}

// How far each constraint is missed, in scales, signed; 0 where it is kept.
VectorX missed(const optimize::MinimizeProblem& problem, const VectorX& values,
               const VectorX& scales) {
  VectorX miss(scales.size());
  for (Eigen::Index i = 0; i < miss.size(); ++i) {
    const auto& c = problem.constraints[static_cast<std::size_t>(i)];
    const double value = values[i + 1];
    miss[i] = (value - std::clamp(value, c.lower, c.upper)) / scales[i];
  }
  return miss;
}

// A sample brought onto what it misses by the least steps, with the Jacobian of
// the optimum and Broyden's corrections of it (C. G. Broyden, Math. Comput. 19,
// 1965); nothing where that leads out of the bounds or to no film.
class Restorer {
 public:
  Restorer(Loop& loop, const optimize::MinimizeReport& optimum)
      : loop_(loop), problem_(loop.problem()) {
    const auto count = static_cast<Eigen::Index>(problem_.constraints.size());
    const auto n = static_cast<Eigen::Index>(problem_.variables.size());
    scales_ = VectorX(count);
    low_ = high_ = VectorX(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      low_[j] = problem_.variables[static_cast<std::size_t>(j)].lower;
      high_[j] = problem_.variables[static_cast<std::size_t>(j)].upper;
    }
    const VectorX ranges = high_ - low_;
    jacobian_ = optimum.jacobian.bottomRows(count) * ranges.asDiagonal();
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& c = problem_.constraints[static_cast<std::size_t>(i)];
      const double bound = std::isfinite(c.upper) ? c.upper : c.lower;
      scales_[i] = bound != 0.0 ? std::abs(bound)
                                : jacobian_.row(i).cwiseAbs().maxCoeff();
      jacobian_.row(i) /= scales_[i];
    }
  }

  // The objective of the feasible design.
  std::optional<double> restored(VectorX x) const {
    const VectorX ranges = high_ - low_;
    Eigen::MatrixXd J = jacobian_;
    for (int k = 0; k < kCorrections; ++k) {
      const optimize::VectorAnswer answer = loop_.values(x);
      if (answer.failure) {
        return std::nullopt;
      }
      const VectorX miss = missed(problem_, answer.values, scales_);
      if (miss.cwiseAbs().maxCoeff() <= kMissed) {
        return answer.values[0];
      }
      // Broyden's update, by the last step of the rows that are missed.
      for (Eigen::Index i = 0; k > 0 && i < miss.size(); ++i) {
        if (miss[i] != 0.0 && aimed_[i] != 0.0) {
          J.row(i) += (miss[i] / step_.squaredNorm()) * step_.transpose();
        }
      }
      Eigen::MatrixXd active = J;
      for (Eigen::Index i = 0; i < miss.size(); ++i) {
        active.row(i) *= miss[i] != 0.0 ? 1.0 : 0.0;
      }
      step_ = -active.completeOrthogonalDecomposition().solve(miss);
      aimed_ = miss;
      x += ranges.cwiseProduct(step_);
      if ((x - low_).minCoeff() < 0.0 || (high_ - x).minCoeff() < 0.0) {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  // On all sides of the centre.
  VectorX about(const VectorX& centre, const VectorX& t) const {
    VectorX shift = 2.0 * kReach * (t.array() - 0.5);
    shift.tail(kVolumes) *= kVolumeReach / kReach;
    return (centre + shift.cwiseProduct(high_ - low_))
        .cwiseMax(low_)
        .cwiseMin(high_);
  }

 private:
  Loop& loop_;
  optimize::MinimizeProblem problem_;
  VectorX scales_;
  VectorX low_;
  VectorX high_;
  Eigen::MatrixXd jacobian_;  // by x / range, of constraints / scale
  mutable VectorX step_;
  mutable VectorX aimed_;
};

TEST(TwoArmSized, TwoStartsComeToOneMassAndNoSampleIsLighter) {
  const case_data::Case input =
      reader::read_case(kCase, {"resolution.fea=22", "resolution.film=11"});
  Loop loop(input);
  ASSERT_TRUE(loop.usable());
  const optimize::MinimizeReport optimum =
      minimum_from(loop, start({4, 25.5, 25.8, 26.2, 65, 62.5, 24.4, 23.6, 60.5,
                                3.45e5, 2.05e5, 2e5}));
  ASSERT_EQ(optimum.termination, optimize::Termination::Converged)
      << optimum.message;
  EXPECT_LE(optimum.first_order->residual, kOptimality);
  const optimize::MinimizeReport other = minimum_from(
      loop,
      start({8, 27, 26.5, 27.5, 70, 62, 25, 25.5, 62, 3.9e5, 2.2e5, 2.15e5}));
  EXPECT_EQ(other.termination, optimize::Termination::Converged)
      << other.message;
  EXPECT_LE(other.first_order->residual, kOptimality);
  EXPECT_NEAR(other.objective / optimum.objective, 1.0, kOneMass);

  const Restorer restorer(loop, optimum);
  int tried = 0;
  int feasible = 0;
  int lighter = 0;  // of the feasible, as they were drawn
  double least = HUGE_VAL;
  for (const VectorX& t : samples::latin_hypercube_samples(
           static_cast<int>(input.design.size()), kMostTries * kSamples, 1)) {
    if (feasible >= kSamples && lighter >= kLighter) {
      break;
    }
    ++tried;
    const VectorX x = restorer.about(optimum.best, t);
    if (const std::optional<double> mass = restorer.restored(x)) {
      ++feasible;
      lighter +=
          x.tail(kVolumes).sum() < optimum.best.tail(kVolumes).sum() ? 1 : 0;
      least = std::min(least, *mass / optimum.objective);
      EXPECT_GE(*mass, optimum.objective * (1.0 - kGain));
    }
  }
  std::cout << fmt::format(
      "{} of {} samples feasible, {} of them drawn below the optimum's volume; "
      "the lightest has {:.5f} of its mass\n",
      feasible, tried, lighter, least);
  EXPECT_GE(feasible, kSamples);
  EXPECT_GE(lighter, kLighter);
}

}  // namespace
}  // namespace meniscus::two_arm_sized_test
