#include "pipeline/forward/exclusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/forward/part_warnings.h"
#include "tests/support/case_text.h"
#include "tests/support/parts.h"

namespace meniscus::exclusion_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string with_zones(const std::string& zones) {
  return strut() + "[analysis]\nexclude = " + zones + "\n";
}

TEST(ExclusionZones, AreReadWithTheirPlace) {
  const reader::CaseReading reading = reader::read_case_text(
      with_zones("[{ near = \"foot_pad\", distance = \"0.5 cm\" },\n"
                 "  { center = [0, 0, \"length\"], radius = 7 },\n"
                 "  { low = [-1, -2, -3], high = [1, 2, 3] }]"),
      "case.toml");
  ASSERT_THAT(reading.problems, IsEmpty());
  const auto& zones = reading.input->analysis.exclude;
  ASSERT_EQ(zones.size(), 3U);
  EXPECT_EQ(zones[0].zone.surface, "foot_pad");
  EXPECT_EQ(zones[0].zone.distance, 5.0);
  EXPECT_EQ(zones[1].zone.ball->center, Vec3(0, 0, 60));
  EXPECT_EQ(zones[1].zone.ball->radius, 7.0);
  EXPECT_EQ(zones[2].zone.box->low, Vec3(-1, -2, -3));
  EXPECT_EQ(zones[2].zone.box->high, Vec3(1, 2, 3));
  EXPECT_EQ(zones[2].key, "analysis.exclude[2]");
  EXPECT_EQ(zones[1].line, zones[0].line + 1);
}

TEST(ExclusionZones, ThatMakeNoSenseAreRefusedByLine) {
  const auto refused = [](const std::string& zone, const std::string& what) {
    EXPECT_THAT(problems_of(with_zones("[" + zone + "]")),
                ElementsAre(AllOf(HasSubstr("case.toml:"), HasSubstr(what))))
        << zone;
  };
  refused("{ near = \"foot_pad\" }", "expected the two keys of one");
  refused("{ near = \"foot_pad\", radius = 2 }", "expected the two keys");
  refused("{ near = \"foot_pad\", distance = 2, radius = 2 }",
          "expected the two keys");
  refused("{ near = \"foot_pat\", distance = 2 }", "foot_pad");
  refused("{ near = \"foot_pad\", distance = 0 }",
          "distance is 0; it must be above 0");
  refused("{ center = [0, 0, 0], radius = -1 }", "must be above 0");
  refused("{ center = [0, 0, 0], radius = \"foot\" }", "same for every design");
  refused("{ low = [0, 0, 0], high = [1, 0, 1] }", "is empty");
  refused("{ near = \"foot_pad\", distance = 2, width = 1 }",
          "unknown key 'width'");
  EXPECT_THAT(problems_of(with_zones("[]")),
              ElementsAre(HasSubstr("tables, at least one: [{ near")));
}

TEST(ExclusionZones, BelongToWhatAStudyMustNotMix) {
  const std::string zone = "[{ near = \"foot_pad\", distance = 5 }]";
  EXPECT_NE(reader::read_case_text(with_zones(zone), "case.toml").input->hash,
            reader::read_case_text(strut(), "case.toml").input->hash);
}

/// A clamped bar pulled along x: its stress concentrates at x = 0.
forward::EvaluationFields clamped_bar() {
  forward::EvaluationFields fields;
  fields.mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 1.0, 1.0}, 12, 4, 4));
  element::Material steel = parts::steel();
  steel.yield_strength = 110.0;
  fields.inputs.materials = {steel};
  loads::LoadCase pull{.name = "pull"};
  pull.supports = {{"x0", true, true, true}};
  pull.forces = {{"x1", {100.0, 0.0, 0.0}}};
  fields.inputs.load_cases = {pull};
  fields.solution =
      elastic::ElasticModel(fields.mesh, fields.inputs.materials, {pull})
          .base_solution();
  fields.stresses =
      forward::part_stresses(fields.mesh, fields.inputs, fields.solution);
  return fields;
}

case_data::Case with_zone(const stress::ExclusionZone& zone) {
  case_data::Case input;
  input.path = "case.toml";
  input.units.length = "mm";
  input.units.pressure = "MPa";
  input.analysis.exclude = {{zone, "analysis.exclude[0]", 17}};
  return input;
}

TEST(ExclusionZones, TakeAClampsPeakOutOfAllFiguresAndTellIt) {
  forward::EvaluationFields fields = clamped_bar();
  const forward::StressFigures whole = forward::stress_figures(fields).front();
  EXPECT_GT(whole.max_von_mises, 115.0);
  EXPECT_LT(whole.position.x(), 0.1);
  EXPECT_FALSE(whole.excluded);

  const case_data::Case input = with_zone({.surface = "x0", .distance = 2.0});
  fields.exclusion = forward::choose_exclusion(input, fields.mesh);
  const forward::StressFigures counted =
      forward::stress_figures(fields).front();
  // Saint-Venant: two widths off the clamp the bar is evenly stressed.
  constexpr double kEven = 0.02;
  EXPECT_NEAR(counted.max_von_mises, 100.0, 100.0 * kEven);
  EXPECT_NEAR(counted.uniformity->von_mises.peak, 100.0, 100.0 * kEven);
  EXPECT_LT(counted.uniformity->von_mises.gini, kEven);
  EXPECT_GT(whole.uniformity->von_mises.gini,
            5.0 * counted.uniformity->von_mises.gini);
  EXPECT_NEAR(counted.safety->factor, 1.1, kEven);
  ASSERT_TRUE(counted.excluded);
  EXPECT_EQ(counted.excluded->max_von_mises, whole.max_von_mises);
  EXPECT_EQ(counted.excluded->position, whole.position);
  EXPECT_EQ(counted.excluded->safety->factor, whole.safety->factor);
  EXPECT_THAT(forward::part_warnings(input, fields, {counted}),
              ElementsAre(HasSubstr("stress above yield in an exclusion zone: "
                                    "load case 'pull'")));

  EXPECT_THAT(forward::stress_text({counted}, input.units),
              HasSubstr("in what is left out 1"));
  const auto told = forward::stress_json({counted})["pull"];
  EXPECT_EQ(told["excluded"]["max_von_mises"], whole.max_von_mises);
  EXPECT_TRUE(told["excluded"].contains("safety_factor"));
}

// Elements are longer than the zone is deep: none has its centre in it.
TEST(ExclusionZones, TakeNodesOutOfPeaksAndNothingIsHidden) {
  forward::EvaluationFields fields = clamped_bar();
  const forward::StressFigures whole = forward::stress_figures(fields).front();
  fields.exclusion =
      forward::choose_exclusion(with_zone({.surface = "x0", .distance = 0.02}),
                                fields.mesh, forward::EmptyZones::Allowed);
  ASSERT_EQ(fields.exclusion.all.elements, 0);
  const forward::StressFigures counted =
      forward::stress_figures(fields).front();
  for (const stress::Peak* peak :
       {&counted.readings.recovered, &counted.readings.averaged}) {
    EXPECT_GT(peak->position.x(), 0.02);
  }
  EXPECT_LT(counted.max_von_mises, whole.max_von_mises);
  ASSERT_TRUE(counted.excluded);
  EXPECT_EQ(counted.excluded->max_von_mises, whole.max_von_mises);
  EXPECT_FALSE(counted.singular);
}

TEST(ExclusionZones, AClampsRimHasNoLimitUntilItIsLeftOut) {
  forward::EvaluationFields fields = clamped_bar();
  const forward::StressFigures whole = forward::stress_figures(fields).front();
  ASSERT_TRUE(whole.singular);
  EXPECT_TRUE(whole.singular->clamped);
  EXPECT_EQ(whole.singular->surfaces[0], "x0");
  EXPECT_EQ(whole.singular->position.x(), 0.0);
  EXPECT_NEAR(forward::growth_of_peak(whole),
              whole.singular->grown - whole.max_von_mises, 1e-9);
  EXPECT_THAT(
      forward::part_warnings(with_zone({}), fields, {whole}),
      testing::Contains(AllOf(
          HasSubstr("the peak stress of 'pull' has no limit: at (0, "),
          HasSubstr("the held 'x0' ends at '"),
          HasSubstr("90 degrees of material"), HasSubstr("grows by 22 %"))));
  EXPECT_TRUE(forward::stress_json({whole})["pull"].contains("no_limit"));
}

TEST(ExclusionZones, AreStatedWithTheirShareOfTheVolume) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 1.0}, 12, 4, 4);
  case_data::Case input = with_zone({});
  input.analysis.exclude[0].zone.box = {{-1.0, -1.0, -1.0}, {1.0, 2.0, 2.0}};
  const forward::Exclusion chosen = forward::choose_exclusion(input, mesh);
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR(chosen.all.volume_share, 0.25, kRounding);
  EXPECT_EQ(chosen.all.elements, mesh.element_count() / 4);
  const auto told = forward::exclusion_json(chosen);
  EXPECT_EQ(told["zones"][0]["where"], "from (-1, -1, -1) to (1, 2, 2)");
  EXPECT_NEAR(told["zones"][0]["volume_share"].get<double>(), 0.25, kRounding);
  input.analysis.exclude[0].zone.box.reset();
  input.analysis.exclude[0].zone.ball = {{0.0, 0.0, 0.0}, 1.0};
  EXPECT_NEAR(forward::choose_exclusion(input, mesh).all.volume_share,
              3.14159 / 6.0 / 4.0, 0.02);  // an eighth of a ball, by elements
}

TEST(ExclusionZones, OfNoElementOrEveryElementAreRefusedByPlace) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 1.0}, 4, 1, 1);
  const auto message = [&](const stress::ExclusionZone& zone) -> std::string {
    try {
      forward::choose_exclusion(with_zone(zone), mesh);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message({.surface = "x0", .distance = 0.01}),
              AllOf(HasSubstr("case.toml:17: analysis.exclude[0]"),
                    HasSubstr("no element has its centre within 0.01 mm of "
                              "'x0'")));
  EXPECT_THAT(message({.surface = "x0", .distance = 9.0}),
              AllOf(HasSubstr("case.toml:17: analysis.exclude[0]"),
                    HasSubstr("leave no element to count")));
  EXPECT_EQ(
      forward::choose_exclusion(with_zone({.surface = "x0", .distance = 0.01}),
                                mesh, forward::EmptyZones::Allowed)
          .all.elements,
      0);
}

}  // namespace
}  // namespace meniscus::exclusion_test
