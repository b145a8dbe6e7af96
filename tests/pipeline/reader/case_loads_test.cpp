#include <gmock/gmock.h>

#include "tests/support/case_text.h"

namespace meniscus::case_loads_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kSupports = "[{ on = \"foot_pad\", fix = \"xyz\" }]";
const char* const kLoads = "[{ on = \"head_pad\", force = [\"load\", 0, 0] }]";

std::string with_supports(const std::string& supports) {
  return changed(strut(), kSupports, supports);
}

std::string with_loads(const std::string& loads) {
  return changed(strut(), kLoads, loads);
}

std::string with_material(const std::string& lines) {
  return changed(strut(), "youngs_modulus = 71700.0\npoisson_ratio = 0.33\n",
                 lines);
}

/// The numbers of a text that must be right, at its initial design.
case_data::EvaluatedCase numbers_of(const std::string& text) {
  const reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  return reading.input
             ? case_data::evaluate(*reading.input,
                                   case_data::initial_design(*reading.input))
             : case_data::EvaluatedCase{};
}

TEST(CaseLoads, SupportsSlideTurnAndSpring) {
  const case_data::EvaluatedCase inputs = numbers_of(with_supports(
      "[{ on = \"foot_pad\", fix = \"symmetry\" },\n"
      "  { on = \"skin\", fix = \"normal\" },\n"
      "  { on = \"head_pad\", fix = \"xz\", axes = [[1, 1, 0], [0, 1, 0]] },\n"
      "  { on = \"foot_pad\", stiffness = [1, \"load / 10\", 3], "
      "normal_stiffness = 5, stiffness_of = \"total\" }]"));
  const loads::LoadCase& load_case = inputs.load_cases.at(0);
  ASSERT_EQ(load_case.supports.size(), 3U);
  EXPECT_EQ(load_case.supports[0].kind, loads::SupportKind::Symmetry);
  EXPECT_EQ(load_case.supports[1].kind, loads::SupportKind::Normal);
  EXPECT_EQ(load_case.supports[2].kind, loads::SupportKind::Components);
  EXPECT_FALSE(load_case.supports[2].fix_y);
  EXPECT_EQ(load_case.supports[2].axes->first, Vec3(1, 1, 0));
  ASSERT_EQ(load_case.springs.size(), 1U);
  EXPECT_EQ(load_case.springs[0].components, Vec3(1, 100, 3));
  EXPECT_EQ(load_case.springs[0].normal, 5.0);
  EXPECT_EQ(load_case.springs[0].measure, loads::SpringMeasure::Total);
}

TEST(CaseLoads, EveryKindOfLoadIsRead) {
  const case_data::EvaluatedCase inputs = numbers_of(changed(
      with_loads(
          "[{ on = \"head_pad\", force = [1, 2, 3], at = [0, 0, 90], "
          "moment = [\"4 N m\", 0, 0] },\n"
          "  { on = \"head_pad\", pressure = \"load * (z - 60) + 2\" },\n"
          "  { on = \"skin\", pressure = 3 },\n"
          "  { on = \"head_pad\", traction = [\"x\", 0, \"foot\"] },\n"
          "  { gravity = [0, 0, -9810] },\n"
          "  { spin = 30, axis = [0, 0, 1], at = [5, 0, 0] },\n"
          "  { temperature = \"20 + z\", reference = 20 }]"),
      "density", "thermal_expansion = 2e-5\ndensity"));
  const loads::LoadCase& load_case = inputs.load_cases.at(0);
  ASSERT_EQ(load_case.remote_loads.size(), 1U);
  EXPECT_EQ(load_case.remote_loads[0].point, Vec3(0, 0, 90));
  EXPECT_EQ(load_case.remote_loads[0].moment, Vec3(4000, 0, 0));
  ASSERT_EQ(load_case.pressures.size(), 2U);
  EXPECT_EQ(load_case.pressures[0].field(Vec3(0, 0, 61)), 1002.0);
  EXPECT_FALSE(load_case.pressures[1].field);
  EXPECT_EQ(load_case.pressures[1].pressure, 3.0);
  ASSERT_EQ(load_case.tractions.size(), 1U);
  EXPECT_EQ(load_case.tractions[0].field(Vec3(7, 0, 0)), Vec3(7, 0, 25));
  EXPECT_EQ(load_case.gravity, Vec3(0, 0, -9810));
  EXPECT_EQ(load_case.spin->rate, 30.0);
  EXPECT_EQ(load_case.temperature->field(Vec3(0, 0, 5)), 25.0);
  EXPECT_EQ(load_case.temperature->reference, 20.0);
}

TEST(CaseLoads, SeveralSurfacesInOneEntry) {
  std::string text = with_supports(
      "[{ on = [\"foot_pad\", \"skin\"], fix = \"xy\" },\n"
      "  { on = [\"foot_pad\", \"skin\"], normal_stiffness = 2 }]");
  text = changed(text, kLoads,
                 "[{ on = [\"head_pad\", \"skin\"], force = [1, 2, 3] },\n"
                 "  { on = [\"head_pad\", \"skin\"], moment = [0, 0, 5], at = "
                 "[0, 0, 90] },\n"
                 "  { on = [\"head_pad\", \"skin\"], pressure = 3 },\n"
                 "  { on = [\"head_pad\"], traction = [0, 0, \"x\"] }]");
  const loads::LoadCase load_case = numbers_of(text).load_cases.at(0);
  const loads::Surfaces both = {"head_pad", "skin"};
  ASSERT_EQ(load_case.forces.size(), 1U);
  EXPECT_EQ(load_case.forces[0].surfaces, both);
  ASSERT_EQ(load_case.remote_loads.size(), 1U);
  EXPECT_EQ(load_case.remote_loads[0].surfaces, both);
  ASSERT_EQ(load_case.pressures.size(), 2U);
  EXPECT_EQ(load_case.pressures[1].surface, "skin");
  EXPECT_EQ(load_case.pressures[1].pressure, 3.0);
  ASSERT_EQ(load_case.tractions.size(), 1U);
  ASSERT_EQ(load_case.supports.size(), 2U);
  EXPECT_EQ(load_case.supports[1].surface, "skin");
  EXPECT_TRUE(load_case.supports[1].fix_y);
  ASSERT_EQ(load_case.springs.size(), 2U);
  EXPECT_EQ(load_case.springs[1].normal, 2.0);
}

TEST(CaseLoads, RigidPinsAndEnforcedDisplacements) {
  std::string text = with_supports(
      "[{ on = \"skin\", fix = \"xz\", displacement = [\"foot / 50\", 0, "
      "\"1 cm\"] },\n"
      "  { on = [\"foot_pad\"], by = \"rigid\", fix = \"xyz\", fix_rotation = "
      "\"xz\", at = [0, 0, \"-foot\"], rotation = [\"load / 1e6\", 0, 0] }]");
  text =
      changed(text, kLoads,
              "[{ on = \"head_pad\", by = \"rigid\", force = [1, 2, 3], at = "
              "[0, 0, 90] },\n"
              "  { on = \"head_pad\", by = \"rigid\", moment = [4, 0, 0] },\n"
              "  { on = \"foot_pad\", by = \"rigid\", force = [0, 5, 0] }]");
  const loads::LoadCase load_case = numbers_of(text).load_cases.at(0);
  ASSERT_EQ(load_case.supports.size(), 1U);
  EXPECT_EQ(load_case.supports[0].displacement, Vec3(0.5, 0, 10));
  ASSERT_EQ(load_case.pins.size(), 2U);  // loads join what they have in common
  const loads::RigidPin& foot = load_case.pins[0];
  EXPECT_EQ(foot.surfaces, loads::Surfaces("foot_pad"));
  EXPECT_EQ(foot.fix, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(foot.fix_rotation, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(foot.point, Vec3(0, 0, -25));
  EXPECT_EQ(foot.rotation, Vec3(1e-3, 0, 0));
  EXPECT_FALSE(foot.displacement);
  EXPECT_FALSE(load_case.pins[1].holds());
  EXPECT_EQ(load_case.remote_loads.size(), 2U);
  EXPECT_EQ(load_case.forces.size(), 1U);
}

TEST(CaseLoads, APinIsOneWhateverTheOrderOfItsSurfaces) {
  const loads::LoadCase load_case =
      numbers_of(
          with_loads("[{ on = [\"skin\", \"head_pad\"], by = \"rigid\", "
                     "force = [1, 0, 0] },\n"
                     "  { on = [\"head_pad\", \"skin\"], by = \"rigid\", "
                     "force = [0, 1, 0] }]"))
          .load_cases.at(0);
  EXPECT_EQ(load_case.pins.size(), 1U);
  EXPECT_EQ(load_case.forces.size(), 2U);
}

TEST(CaseLoads, BearingForces) {
  const loads::LoadCase load_case =
      numbers_of(
          with_loads("[{ on = [\"skin\", \"head_pad\"], by = "
                     "\"bearing\", force = [\"load\", 0, 0] },\n"
                     "  { on = \"skin\", by = \"bearing\", force = [0, "
                     "3, 0], at = [0, 0, \"foot\"], axis = [0, 0, 2] }]"))
          .load_cases.at(0);
  ASSERT_EQ(load_case.bearings.size(), 2U);
  EXPECT_EQ(load_case.bearings[0].surfaces.size(), 2U);
  EXPECT_EQ(load_case.bearings[0].force, Vec3(1000, 0, 0));
  EXPECT_FALSE(load_case.bearings[0].point);
  EXPECT_FALSE(load_case.bearings[0].axis);
  EXPECT_EQ(load_case.bearings[1].point, Vec3(0, 0, 25));
  EXPECT_EQ(load_case.bearings[1].axis, Vec3(0, 0, 2));
  EXPECT_TRUE(load_case.forces.empty());
  EXPECT_TRUE(load_case.pins.empty());
}

TEST(CaseLoads, ADisplacementIsALoad) {
  const std::string moved = changed(
      with_supports("[{ on = \"foot_pad\", fix = \"xyz\" }, { on = "
                    "\"head_pad\", fix = \"z\", displacement = [0, 0, 0.1] }]"),
      std::string("loads = ") + kLoads, "");
  EXPECT_TRUE(numbers_of(moved).load_cases.at(0).forces.empty());
}

TEST(CaseLoads, MaterialsAreIsotropicOrOrthotropic) {
  EXPECT_EQ(numbers_of(changed(strut(), "density = 2.8e-9",
                               "density = 2.8e-9\nthermal_expansion = 2e-5"))
                .materials.at(0)
                .thermal_expansion,
            Vec3::Constant(2e-5));
  const element::Material m =
      numbers_of(with_material("youngs_moduli = [\"120 GPa\", 9e3, 7e3]\n"
                               "poisson_ratios = [0.3, 0.25, 0.4]\n"
                               "shear_moduli = [4500, 4000, 3000]\n"
                               "axes = [[0, 0, 1], [1, 0, 0]]\n"
                               "thermal_expansions = [1e-6, 2e-5, 3e-5]\n"))
          .materials.at(0);
  ASSERT_TRUE(m.orthotropic);
  EXPECT_EQ(m.orthotropic->youngs_moduli, Vec3(120e3, 9e3, 7e3));
  EXPECT_EQ(m.orthotropic->axes.first, Vec3::UnitZ());
  EXPECT_EQ(m.thermal_expansion, Vec3(1e-6, 2e-5, 3e-5));
}

struct Mistake {
  const char* name;
  std::string text;
  const char* told;
};

class LoadMistake : public testing::TestWithParam<Mistake> {};

TEST_P(LoadMistake, IsToldWithItsLine) {
  EXPECT_THAT(problems_of(GetParam().text),
              Contains(HasSubstr(GetParam().told)));
}

INSTANTIATE_TEST_SUITE_P(
    CaseLoads, LoadMistake,
    testing::Values(
        Mistake{"NoFix", with_supports("[{ on = \"foot_pad\" }]"),
                "51: load_cases.service.supports on 'foot_pad' has neither fix "
                "nor springs"},
        Mistake{"FixAndSprings",
                with_supports("[{ on = \"foot_pad\", fix = \"x\", "
                              "normal_stiffness = 1 }]"),
                "has both fix and springs"},
        Mistake{"AxesOfNormal",
                with_supports("[{ on = \"foot_pad\", fix = \"normal\", axes = "
                              "[[1,0,0],[0,1,0]] }]"),
                "axes does not belong to fix = \"normal\""},
        Mistake{"ParallelAxes",
                with_supports("[{ on = \"foot_pad\", fix = \"xyz\", axes = "
                              "[[1,0,0],[2,0,0]] }]"),
                "expected two directions that span a plane"},
        Mistake{"NegativeSpring",
                with_supports("[{ on = \"foot_pad\", normal_stiffness = -1 }]"),
                "stiffnesses are 0 or above"},
        Mistake{"TwoLoadsInOne",
                with_loads("[{ on = \"head_pad\", force = [1,0,0], pressure = "
                           "3 }]"),
                "52: load_cases.service.loads on 'head_pad' has force and "
                "pressure; expected one of"},
        Mistake{"TotalSpringsOnSeveral",
                with_supports("[{ on = [\"foot_pad\", \"skin\"], "
                              "normal_stiffness = 1, stiffness_of = \"total\" "
                              "}]"),
                "stiffness_of is total on several surfaces"},
        Mistake{"SurfaceTwice",
                with_loads("[{ on = [\"skin\", \"skin\"], pressure = 3 }]"),
                "52: load_cases.service.loads.on has 'skin' twice"},
        Mistake{"OneOfSeveralUnknown",
                with_loads("[{ on = [\"skin\", \"skim\"], pressure = 3 }]"),
                "did you mean 'skin'?"},
        Mistake{"SurfaceIsANumber", with_loads("[{ on = 3, pressure = 3 }]"),
                "expected a name, or a list of names"},
        Mistake{"PinByNodesToo",
                with_loads("[{ on = [\"foot_pad\", \"head_pad\"], by = "
                           "\"rigid\", force = [1, 0, 0] }]"),
                "51: surface 'foot_pad' is of a rigid pin of load case "
                "'service' and held by nodes"},
        Mistake{"TwoPins",
                with_loads("[{ on = [\"skin\", \"head_pad\"], by = \"rigid\", "
                           "force = [1, 0, 0] }, { on = \"skin\", by = "
                           "\"rigid\", force = [1, 0, 0] }]"),
                "surface 'skin' is of two rigid pins of load case 'service'"},
        Mistake{"RigidSupportNowhere",
                with_supports("[{ on = \"foot_pad\", by = \"rigid\", fix = "
                              "\"xyz\" }]"),
                "is rigid and has no 'at'"},
        Mistake{"RotationOfNodes",
                with_supports("[{ on = \"foot_pad\", fix = \"xyz\", "
                              "fix_rotation = \"x\" }]"),
                "fix_rotation does not belong to a support by nodes"},
        Mistake{"DisplacementAlongNormals",
                with_supports("[{ on = \"foot_pad\", fix = \"normal\", "
                              "displacement = [1, 0, 0] }]"),
                "displacement does not belong to fix = \"normal\""},
        Mistake{"DisplacementOfSprings",
                with_supports("[{ on = \"foot_pad\", normal_stiffness = 1, "
                              "displacement = [1, 0, 0] }]"),
                "displacement does not belong to springs"},
        Mistake{"DisplacementOfWhatIsFree",
                with_supports("[{ on = \"foot_pad\", fix = \"xy\", "
                              "displacement = [0, 0, 0.2] }]"),
                "must be 0 where fix does not hold that component"},
        Mistake{"ConeInDegreesWithoutUnit",
                with_loads("[{ on = \"skin\", size = 3, within = 30, about = "
                           "[0, 0, 1] }]"),
                "from 0 to 180, with its unit, as \"30 deg\""},
        Mistake{"OverhangInDegreesWithoutUnit",
                changed(strut(), "[study]",
                        "[responses.hangs]\nkind = \"overhang\"\ndirection = "
                        "[0, 0, 1]\nangle = 40\n[study]"),
                "below 90, with its unit, as \"45 deg\""},
        Mistake{
            "WidthBeyondItsAngle",
            changed(strut(), "[study]",
                    "[responses.hangs]\nkind = \"overhang\"\ndirection = "
                    "[0, 0, 1]\nwidth = \"50 deg\"\n[study]"),
            "a part of the angle, 45 degrees, with its unit, as \"4.5 deg\""},
        Mistake{"ByWhat",
                with_loads("[{ on = \"head_pad\", by = \"rigit\", force = "
                           "[1, 0, 0] }]"),
                "did you mean 'rigid'?"},
        Mistake{"MomentOfABearing",
                with_loads("[{ on = \"skin\", by = \"bearing\", moment = [1, "
                           "0, 0], at = [0, 0, 0] }]"),
                "by is bearing: a pin that presses carries a force"},
        Mistake{"ForceAndMomentOfABearing",
                with_loads("[{ on = \"skin\", by = \"bearing\", force = [1, 0, "
                           "0], moment = [1, 0, 0], at = [0, 0, 0] }]"),
                "moment does not belong to a force that is bearing"},
        Mistake{"AxisOfASpreadForce",
                with_loads("[{ on = \"skin\", force = [1, 0, 0], axis = [1, 0, "
                           "0] }]"),
                "axis does not belong to a force that is spread"},
        Mistake{"PressureByAPin",
                with_loads("[{ on = \"head_pad\", by = \"rigid\", pressure = "
                           "3 }]"),
                "by does not belong to a pressure"},
        Mistake{"PressureNowhere", with_loads("[{ pressure = 3 }]"),
                "is a pressure and has no 'on'"},
        Mistake{"GravityOnASurface",
                with_loads("[{ on = \"head_pad\", gravity = [0,0,-1] }]"),
                "on does not belong to a gravity"},
        Mistake{"MomentWithoutPoint",
                with_loads("[{ on = \"head_pad\", force = [1,0,0], moment = "
                           "[1,0,0] }]"),
                "has a force with a moment and no 'at'"},
        Mistake{"SpinWithoutAxis", with_loads("[{ spin = 3, at = [0,0,0] }]"),
                "has a spin and no 'axis'"},
        Mistake{"WeightlessGravity",
                changed(with_loads("[{ gravity = [0,0,-1] }]"), "2.8e-9", "0"),
                "48: materials.aluminium.density is 0, but load case 'service' "
                "has gravity"},
        Mistake{"NothingHot",
                with_loads("[{ temperature = 20, reference = 20 }]"),
                "has no load that is not 0"},
        Mistake{"ColdMaterial",
                with_loads("[{ temperature = 30, reference = 20 }]"),
                "has a temperature, but no material has a thermal expansion"},
        Mistake{"NoModulus", with_material("poisson_ratio = 0.33\n"),
                "materials.aluminium is isotropic and has no "
                "'youngs_modulus'"},
        Mistake{"BothKinds",
                with_material("youngs_modulus = 1\npoisson_ratios = [0,0,0]\n"
                              "youngs_moduli = [1,1,1]\n"
                              "shear_moduli = [1,1,1]\n"),
                "youngs_modulus does not belong to an orthotropic material"},
        Mistake{"NotDefinite",
                with_material("youngs_moduli = [1,1,1]\n"
                              "poisson_ratios = [0.6,0.6,0.6]\n"
                              "shear_moduli = [1,1,1]\n"),
                "45: material 'aluminium': its stiffness is not positive "
                "definite"}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

}  // namespace
}  // namespace meniscus::case_loads_test
