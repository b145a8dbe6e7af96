/// Bounds of nodal stress, fatigue, envelopes and moments of inertia through
/// the whole forward model.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "pipeline/forward/part_stress.h"
#include "pipeline/forward/stress_figures.h"
#include "tests/support/case_text.h"

namespace meniscus::strength_gradient_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two load cases, held alike, and a third that is not.
std::string strong_strut() {
  std::string text = leaning_strut();
  text = changed(text, "density = 2.8e-9",
                 "density = 2.8e-9\nyield_strength = 20\n"
                 "endurance_limit = 12\ntensile_strength = 40\n"
                 "torsion_limit = 7.5\nthermal_expansion = 2.3e-5");
  text = changed(text, "[responses.sway]", R"toml([load_cases.back]
supports = [{ on = "foot_pad", fix = "xyz" }]
loads = [{ on = "head_pad", force = ["-load / 3", "40 * lean", 5e3] }]

[load_cases.warm]
supports = [{ on = "head_pad", fix = "xyz" }]
loads = [{ temperature = "20 + z / 4 + lean", reference = 15 },
         { on = "foot_pad", force = [0, 500, 0] }]

[responses.sway])toml");
  return changed(text, "[study]", R"toml([responses.stress]
kind = "stress_ratio"
load_cases = ["service", "back", "warm"]

[responses.pull]
kind = "stress_ratio"
measure = "tension"
allowable = 25
excess = 0.1

[responses.life]
kind = "fatigue"
load_cases = ["service", "back"]

[responses.crack]
kind = "fatigue"
criterion = "crossland"
load_cases = ["back", "warm"]
excess = 0.05

[responses.swing]
kind = "envelope"
of = "sway"

[responses.least_swing]
kind = "envelope"
responses = ["sway", "sway[back]"]
least = true
excess = 0.1

[responses.spin]
kind = "inertia"
axis = [0, "lean / 9", 1]

[responses.turn]
kind = "inertia"
axis = [0, 1, 0]
through = ["lean", 0, "foot / 2"]

[responses.supports]
kind = "overhang"
direction = ["lean / 10", 0, 1]
angle = "70 deg"
width = "40 deg"
base = ["foot_pad"]

[responses.undercut]
kind = "draft"
direction = ["lean / 10", 1, 0.2]
angle = "30 deg"
width = "25 deg"

[responses.stuck]
kind = "draft"
on = "skin"
direction = [0, 0, -1]
angle = "40 deg"
width = "30 deg"

[study])toml");
}

TEST(StrengthGradient, IsExactThroughTheModel) {
  const case_data::Case input = case_of(strong_strut());
  for (const Eigen::Vector2d& move :
       {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.8, -2.0)}) {
    const forward::CaseGradientCheck check = forward::check_case_gradient(
        input, case_data::initial_design(input) + move);
    EXPECT_TRUE(check.report.passed)
        << forward::gradient_check_text(input, check);
    EXPECT_THAT(check.left_out, testing::IsEmpty());
  }
}

TEST(StrengthResponses, PartsOfEnvelopesStandBeforeThem) {
  EXPECT_THAT(case_data::response_names(case_of(strong_strut())),
              ElementsAre("sway", "mass", "stress[service]", "stress[back]",
                          "stress[warm]", "stress", "pull", "life", "crack",
                          "sway[back]", "sway[warm]", "swing", "least_swing",
                          "spin", "turn", "supports", "undercut", "stuck"));
}

TEST(StrengthResponses, BoundPeaksFromAbove) {
  const case_data::Case input = case_of(strong_strut());
  const forward::ForwardModel model(input);
  forward::EvaluationFields fields;
  const forward::Evaluation there =
      model.evaluate(case_data::initial_design(input), &fields);
  ASSERT_FALSE(there.failure) << there.failure->message;
  fields.stresses =
      forward::part_stresses(fields.mesh, fields.inputs, fields.solution);
  const std::vector<forward::StressFigures> figures =
      forward::stress_figures(fields);
  const auto value = [&](const std::string& name) {
    return there.responses[case_data::response_index(input, name)];
  };
  double worst = 0.0;
  for (const forward::StressFigures& of : figures) {
    const double peak = std::max(of.readings.recovered.von_mises,
                                 of.readings.averaged.von_mises) /
                        20.0;
    const double bound = value("stress[" + of.load_case + "]");
    EXPECT_GE(bound, peak) << of.load_case;
    EXPECT_LE(bound, 1.02 * peak) << of.load_case;
    worst = std::max(worst, bound);
  }
  EXPECT_GE(value("stress"), worst);
  EXPECT_LE(value("stress"), 1.01 * worst);
  EXPECT_GE(value("swing"), value("sway[warm]"));
  EXPECT_LE(value("least_swing"), value("sway[back]"));
}

TEST(StrengthResponses, MistakesAreToldByLine) {
  const auto told = [](const std::string& from, const std::string& to) {
    return problems_of(changed(strong_strut(), from, to));
  };
  EXPECT_THAT(told("yield_strength = 20\n", ""),
              Contains(HasSubstr("whose material 'aluminium' has no "
                                 "yield_strength; add it to the material, or "
                                 "allowable = STRESS here")));
  EXPECT_THAT(told("torsion_limit = 7.5", "torsion_limit = 6.5"),
              Contains(HasSubstr("torsion_limit of at least")));
  EXPECT_THAT(told("endurance_limit = 12", "endurance_limit = -12"),
              Contains(HasSubstr("endurance_limit is -12; it must be above")));
  EXPECT_THAT(told("load_cases = [\"service\", \"back\"]\n",
                   "load_cases = [\"service\"]\n"),
              Contains(HasSubstr("fatigue is between two load cases")));
  EXPECT_THAT(told("of = \"sway\"", "of = \"mass\""),
              Contains(HasSubstr("'mass', which is of no one load case")));
  EXPECT_THAT(told("of = \"sway\"", "of = \"sweep\""),
              Contains(HasSubstr("'sweep'")));
  EXPECT_THAT(told("of = \"sway\"", "responses = [\"sway\", \"mass\"]"),
              Contains(HasSubstr("'sway' and 'mass' are of different units")));
  EXPECT_THAT(told("direction = [0, 0, -1]", "direction = [0, 0, 0]"),
              Contains(HasSubstr("responses.stuck.direction has length 0")));
  EXPECT_THAT(told("angle = \"40 deg\"", "angle = \"95 deg\""),
              Contains(HasSubstr("angle is 95 degrees; expected one above 0")));
  EXPECT_THAT(told("width = \"30 deg\"", "width = \"50 deg\""),
              Contains(HasSubstr("width is 50 degrees; expected a part of the "
                                 "angle, 40 degrees")));
  EXPECT_THAT(told("base = [\"foot_pad\"]", "base = [\"foot_pat\"]"),
              Contains(HasSubstr("'foot_pat'")));
  EXPECT_THAT(told("measure = \"tension\"", "measure = \"rms\""),
              Contains(HasSubstr("it is one of von_mises|tension")));
  EXPECT_THAT(told("excess = 0.1\n\n[responses.life]",
                   "excess = 2\n\n[responses.life]"),
              Contains(HasSubstr("excess is 2; expected a part")));
}

}  // namespace
}  // namespace meniscus::strength_gradient_test
