/// The two-arm bracket's answer as the meshes refine: the order at which it
/// converges, and whether the program's own error estimates are honest.
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/reader/case_reader.h"
#include "pipeline/study/study.h"
#include "tests/support/temp_folder.h"

namespace meniscus::convergence_test {
namespace {

/// Film edges are half of them. Above 16 the rims and the film's least facet
/// count fix the mesh, not the edge asked for.
constexpr std::array<int, 3> kEdges = {16, 8, 6};  // mm
// An estimate of support_x may be short of the true error by this, no more.
constexpr double kShort = 2.0;
constexpr std::array<const char*, 3> kNames = {"support_x", "left", "right"};

/// support_x [mm] and both deflections [mm] at one size, and their estimated
/// errors (none where the coarser model cannot be made).
struct Answer {
  Vec3 value = Vec3::Zero();
  std::optional<Vec3> estimate;
  double size = 0.0;  // elements^(-1/3): halving the edge does not halve it
};

Answer answer(int edge) {
  const TempFolder folder;
  const case_data::Case input = reader::read_case(
      MENISCUS_SOURCE_DIR "/cases/two_arm/case.toml",
      {fmt::format("resolution.fea={}", edge),
       fmt::format("resolution.film={}", edge / 2), "study.tolerance=1e-6"});
  store::StudyStore store = store::StudyStore::start(folder.path().string(),
                                                     {.case_hash = input.hash});
  const study::RunResult result = study::run_study(input, store, {});
  EXPECT_EQ(result.status, study::RunStatus::Converged) << result.message;
  Answer found;
  found.size = std::pow(result.best->tet.elements, -1.0 / 3.0);
  found.value << result.best->design[0], result.best->responses;
  if (result.design_errors.size() == 1 && result.response_errors.size() == 2) {
    found.estimate.emplace(result.design_errors[0], result.response_errors[0],
                           result.response_errors[1]);
  }
  return found;
}

/// The p with (h0^p - h1^p) / (h1^p - h2^p) = ratio, by bisection.
double observed_order(const std::array<double, 3>& h, double ratio) {
  double low = 0.01;
  double high = 10.0;
  while (high - low > 1e-6) {
    const double p = 0.5 * (low + high);
    const double here = (std::pow(h[0], p) - std::pow(h[1], p)) /
                        (std::pow(h[1], p) - std::pow(h[2], p));
    (here < ratio ? low : high) = p;
  }
  return low;
}

TEST(TwoArmConvergence, AnswerConvergesAndItsErrorEstimateIsHonest) {
  std::vector<Answer> answers;
  for (const int edge : kEdges) {
    answers.push_back(answer(edge));
  }
  const std::array<double, 3> h = {answers[0].size, answers[1].size,
                                   answers[2].size};
  // Of support_x, where the order of three meshes says little of its limit:
  // 13.29 mm by four down to 3 mm (docs/verification.md), 0.02 from fit to fit.
  constexpr double kLimit = 13.29;
  for (int q = 0; q < 3; ++q) {
    const double coarse = answers[1].value[q] - answers[0].value[q];
    const double fine = answers[2].value[q] - answers[1].value[q];
    const double order = observed_order(h, coarse / fine);
    EXPECT_GT(order, 0.2) << kNames[q];
    const double limit =
        answers[2].value[q] + fine / (std::pow(h[1] / h[2], order) - 1.0);
    std::cout << fmt::format("{}: order {:.2f}, limit {:.8g}\n", kNames[q],
                             order, limit);
    for (std::size_t k = 0; k < answers.size(); ++k) {
      const double error =
          std::abs(answers[k].value[q] - (q == 0 ? kLimit : limit));
      ASSERT_TRUE(answers[k].estimate);
      const double estimate = (*answers[k].estimate)[q];
      std::cout << fmt::format("  edge {}: {:.8g}, error {:.3g}, est. {:.3g}\n",
                               kEdges[k], answers[k].value[q], error, estimate);
      EXPECT_GT(estimate, 0.0) << kNames[q] << " at " << kEdges[k];
      // Those of the deflections hold for a fixed design, not for the answer;
      // at 16 the coarser mesh is hardly coarser (docs/verification.md).
      if (q == 0 && k > 0) {
        EXPECT_GT(kShort * estimate, error) << "at " << kEdges[k];
      }
    }
  }
}

}  // namespace
}  // namespace meniscus::convergence_test
