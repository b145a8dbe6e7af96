/// Preloaded bolts: closed form, balance, exact gradients.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fea/loads/loads.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "tests/support/case_text.h"

namespace meniscus::bolts_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A bar of 40 x 10 x 10 without contraction, tightened from end to end.
const char* const kBar = R"toml(title = "Bar"
units = "mm-N-MPa"
[curves.low]
kind = "polygon"
points = [[0, 0, 0], [0, 10, 0], [0, 10, 10], [0, 0, 10]]
[curves.high]
kind = "polygon"
points = [[40, 0, 0], [40, 10, 0], [40, 10, 10], [40, 0, 10]]
[solids.foot]
kind = "cap"
curve = "low"
[solids.head]
kind = "cap"
curve = "high"
[solids.skin]
kind = "sides"
curves = ["low", "high"]
[bodies.bar]
enclosed_by = ["foot", "head", "skin"]
material = "steel"
[materials.steel]
youngs_modulus = 210000
poisson_ratio = 0
density = 7.85e-9
[bolts.tie]
preload = "20 kN"
seat = "head"
thread = "foot"
axis = [2, 0, 0]
at = [7, 5, 5]
[load_cases.tightened]
supports = [{ on = "foot", fix = "xyz" }]
[load_cases.pulled]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "head", force = [5000, 0, 0] }]
[responses.shortening]
kind = "mean_displacement"
on = "head"
direction = [-1, 0, 0]
[responses.energy]
kind = "strain_energy"
[responses.less]
kind = "mean_displacement"
on = "head"
direction = [-1, 0, 0]
load_case = "pulled"
[resolution]
fea = 10
[study]
kind = "analyse"
)toml";

TEST(Bolts, ABarBetweenHeadAndThreadShortensByItsTension) {
  const case_data::Case input = case_of(kBar);
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  forward::EvaluationFields fields;
  const forward::Evaluation there =
      model.evaluate(case_data::initial_design(input), &fields);
  ASSERT_FALSE(there.failure) << there.failure->message;
  constexpr double kSolved = 1e-8;  // elements have the field exactly
  const double exact = 2e4 * 40.0 / (210000.0 * 100.0);
  EXPECT_NEAR(there.responses[0], exact, kSolved * exact);
  EXPECT_NEAR(there.responses[1], 0.5 * 2e4 * exact, kSolved * 2e4 * exact);
  EXPECT_NEAR(there.responses[2], 0.75 * exact, kSolved * exact);
  // The support does nothing for it.
  const VectorX& reactions = fields.solution.reactions[0];
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index n = 0; n < reactions.size(); n += 3) {
    sum += reactions.segment<3>(n);
  }
  EXPECT_LT(sum.norm(), kSolved * 2e4);
}

/// A strut that leans, tightened along its axis by a bolt beside it.
std::string leaning(const std::string& bolt) {
  return changed(leaning_strut(), "[load_cases.service]",
                 "[bolts.tie]\n" + bolt + "\n[load_cases.service]");
}

TEST(Bolts, BalanceInForceAndMomentWhereverTheyAre) {
  const case_data::Case input = case_of(
      leaning("preload = 900\nseat = \"head_pad\"\nthread = \"foot_pad\"\n"
              "axis = [\"lean / 9\", 0.2, 1]\nat = [3, \"lean\", 20]\n"));
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure());
  forward::EvaluationFields fields;
  ASSERT_FALSE(
      model.evaluate(case_data::initial_design(input), &fields).failure);
  loads::LoadCase bolt = fields.inputs.load_cases[0];
  bolt.forces.clear();
  ASSERT_EQ(bolt.remote_loads.size(), 2U);
  EXPECT_NEAR(bolt.remote_loads[1].force.norm(), 900.0, 1e-9);
  const VectorX f =
      loads::nodal_forces(fields.mesh, bolt, fields.inputs.materials);
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  double size = 0.0;
  for (std::size_t i = 0; i < fields.mesh.nodes.size(); ++i) {
    const Vec3 here = f.segment<3>(static_cast<Eigen::Index>(3 * i));
    force += here;
    moment += fields.mesh.nodes[i].cross(here);
    size += here.norm();
  }
  constexpr double kRounding = 1e-11;
  EXPECT_LT(force.norm(), kRounding * size);
  EXPECT_LT(moment.norm(), kRounding * size * 100.0);
}

TEST(Bolts, HaveExactGradients) {
  const case_data::Case input =
      case_of(leaning("preload = \"900 + 20 * lean\"\nseat = \"head_pad\"\n"
                      "thread = \"foot_pad\"\naxis = [\"lean / 9\", 0.2, 1]\n"
                      "at = [3, \"lean\", \"foot\"]\n"));
  const forward::CaseGradientCheck check = forward::check_case_gradient(
      input, case_data::initial_design(input) + Eigen::Vector2d(0.8, -2.0));
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
}

TEST(Bolts, OnlyOneWithBothEndsHeldMovesNothing) {
  const auto warnings = [](const std::string& held) {
    const std::string pulled = kBar;
    const std::size_t second = pulled.find("[load_cases.pulled]");
    const std::string one =
        pulled.substr(0, second) + pulled.substr(pulled.find("[responses."));
    return reader::read_case_text(
               changed(changed(one, "on = \"foot\", fix", held + ", fix"),
                       "load_case = \"pulled\"", ""),
               "case.toml")
        .warnings;
  };
  const auto bolt = HasSubstr("the load on 'head' moves nothing");
  EXPECT_THAT(warnings("on = \"head\""), testing::IsEmpty());
  EXPECT_THAT(warnings("on = [\"head\", \"foot\"]"), Contains(bolt));
}

TEST(Bolts, MistakesAreToldByLine) {
  const auto told = [](const char* pattern, const char* wrong) {
    return problems_of(changed(kBar, pattern, wrong));
  };
  EXPECT_THAT(told("preload = \"20 kN\"", "preload = -3"),
              Contains(HasSubstr("above 0")));
  EXPECT_THAT(told("axis = [2, 0, 0]", "axis = [0, 0, 0]"),
              Contains(HasSubstr("a direction with a length")));
  EXPECT_THAT(told("thread = \"foot\"", "thread = \"head\""),
              Contains(HasSubstr("which the head is on")));
  EXPECT_THAT(told("thread = \"foot\"", "thread = \"toe\""),
              Contains(HasSubstr("toe")));
  EXPECT_THAT(told("force = [5000, 0, 0]", "size = 5000"),
              Contains(HasSubstr("such a load acts alone")));
}

}  // namespace
}  // namespace meniscus::bolts_test
