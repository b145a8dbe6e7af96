#include "pipeline/reader/case_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/results/new_case.h"
#include "tests/support/case_text.h"

namespace meniscus::case_reader_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(CaseReader, ReadsTheTwoArmBracket) {
  const reader::CaseReading reading = reader::read_case_file(two_arm_path());
  EXPECT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings, IsEmpty());
  ASSERT_TRUE(reading.input.has_value());
  const case_data::Case& input = *reading.input;
  EXPECT_EQ(input.name, "two_arm");
  EXPECT_EQ(input.title, "Two-arm bracket");
  EXPECT_THAT(case_data::design_names(input), ElementsAre("support_x"));
  EXPECT_THAT(case_data::response_names(input),
              ElementsAre("left_deflection", "right_deflection"));
  EXPECT_EQ(input.curves[0].name, "support");
  EXPECT_EQ(input.curves[2].name, "right");
  EXPECT_EQ(input.resolution.fea, 8.0);
  EXPECT_EQ(input.resolution.film, 4.0);
  EXPECT_EQ(input.resolution.refinements, 1);
  EXPECT_EQ(input.study.kind, case_data::StudyKind::Match);
  EXPECT_THAT(input.study.equal,
              ElementsAre("left_deflection", "right_deflection"));
  EXPECT_EQ(input.study.tolerance, 1e-3);
  EXPECT_EQ(input.study.method, "ceres");
  EXPECT_EQ(case_data::response_unit(input, 0), "mm");
}

TEST(CaseReader, EvaluatesTheTwoArmBracket) {
  const case_data::Case input = reader::read_case(two_arm_path());
  const VectorX moved = VectorX::Constant(1, 12.5);
  const case_data::EvaluatedCase inputs = case_data::evaluate(input, moved);
  const auto& support =
      std::get<curves::Circle>(inputs.film_system.curves[0].shape);
  EXPECT_EQ(support.center, Vec3(12.5, 0, 0));
  EXPECT_EQ(support.normal, Vec3(0, 0, -1));
  EXPECT_EQ(support.radius, 35.0);
  const auto& left =
      std::get<curves::Circle>(inputs.film_system.curves[1].shape);
  const double angle = 60.0 * (3.14159265358979323846 / 180.0);
  EXPECT_EQ(left.normal, Vec3(-std::sin(angle), 0, std::cos(angle)));
  EXPECT_EQ(inputs.film_system.bodies[0].volume, 1.7e6);
  EXPECT_EQ(inputs.materials[0].youngs_modulus, 71700.0);
  EXPECT_EQ(inputs.materials[0].density, 2.8e-9);
  EXPECT_EQ(inputs.materials[0].yield_strength, 400.0);
  ASSERT_EQ(inputs.load_cases[0].forces.size(), 2U);
  EXPECT_EQ(inputs.load_cases[0].forces[0].total, Vec3(0, 0, -40000));
  EXPECT_EQ(inputs.load_cases[0].forces[1].total, Vec3(0, 0, -60000));
  EXPECT_TRUE(inputs.load_cases[0].supports[0].fix_y);
  EXPECT_EQ(inputs.responses[1].direction, Vec3(0, 0, -1));
  EXPECT_THROW(case_data::evaluate(input, VectorX()), InvalidInput);
}

TEST(CaseReader, ReadsTheTextOfANewCase) {
  for (const std::string name : {"strut", "a \"quoted\" \\ name", ""}) {
    const reader::CaseReading reading =
        reader::read_case_text(results::new_case_text(name), "case.toml");
    EXPECT_THAT(reading.problems, IsEmpty());
    EXPECT_THAT(reading.warnings, IsEmpty());
    ASSERT_TRUE(reading.input.has_value());
    EXPECT_EQ(reading.input->title, name);
  }
}

TEST(CaseReader, TakesParametersFromParametersAndUnits) {
  const reader::CaseReading good = reader::read_case_text(
      changed(strut(), "load = 1000.0",
              "load = \"2 * unit_load + more\"\nunit_load = \"1 kN\"\n"
              "more = \"20 N\""),
      "case.toml");
  ASSERT_TRUE(good.input.has_value()) << good.problems[0];
  const auto values = case_data::parameter_values(
      *good.input, case_data::initial_design(*good.input));
  EXPECT_THAT(values, Contains(std::make_pair(std::string("load"), 2020.0)));
}

TEST(CaseReader, TellsABadParameterOnce) {
  EXPECT_THAT(problems_of(changed(strut(), "load = 1000.0",
                                  "load = \"1 / zero\"\nzero = 0")),
              ElementsAre(HasSubstr("case.toml:5: parameters.load: division of "
                                    "1 by zero in '1 / zero' where zero = 0")));
}

TEST(CaseReader, NamesParametersThatDependInACircle) {
  EXPECT_THAT(problems_of(changed(strut(), "load = 1000.0",
                                  "load = \"a\"\na = \"b + 1\"\nb = \"a\"")),
              Contains(AllOf(HasSubstr("in a circle: a -> b -> a"),
                             HasSubstr("give one of them a number"))));
  EXPECT_THAT(
      problems_of(changed(strut(), "load = 1000.0", "load = \"load\"")),
      Contains(HasSubstr("case.toml:5: parameters depend on each other in a "
                         "circle: load -> load")));
}

TEST(CaseReader, LetsConstantsBeExpressionsOfParameters) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(changed(strut(), "fea = 6.0", "fea = \"length / 10\""),
              "targets = { sway = 0.01 }", "targets = { sway = \"1 cm\" }"),
      "case.toml");
  ASSERT_TRUE(reading.input.has_value()) << reading.problems[0];
  EXPECT_EQ(reading.input->resolution.fea, 6.0);
  EXPECT_EQ(reading.input->study.targets[0].second, 10.0);
  EXPECT_THAT(problems_of(changed(strut(), "fea = 6.0", "fea = \"foot / 4\"")),
              Contains(HasSubstr("resolution.fea depends on 'foot', which a "
                                 "design variable moves")));
  EXPECT_THAT(
      problems_of(changed(strut(), "sway = 0.01", "sway = \"1 N\"")),
      Contains(HasSubstr("the text '1 N', a force; expected a length")));
}

TEST(CaseReader, KeepsTheFilesOrderOfParameters) {
  const std::string text =
      changed(strut(), "load = 1000.0", "zeta = 3\nload = 1000.0\nalpha = 4");
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{}, {"zeta=5", "length=61"}}) {
    const reader::CaseReading reading =
        reader::read_case_text(text, "case.toml", overrides);
    ASSERT_TRUE(reading.input.has_value()) << reading.problems[0];
    std::vector<std::string> names;
    for (const case_data::Parameter& parameter : reading.input->parameters) {
      names.push_back(parameter.name);
    }
    EXPECT_EQ(names,
              (std::vector<std::string>{"zeta", "load", "alpha", "length"}));
  }
}

TEST(CaseReader, OverridesBeginATableThatTheFileLeavesOut) {
  const std::string text = strut();
  ASSERT_EQ(text.find("[analysis]"), std::string::npos);
  const reader::CaseReading reading =
      reader::read_case_text(text, "case.toml", {"analysis.buckling=0"});
  ASSERT_TRUE(reading.input.has_value()) << reading.problems[0];
  EXPECT_EQ(reading.input->analysis.buckling, 0);
  EXPECT_NE(
      reader::read_case_text(text, "case.toml", {}).input->analysis.buckling,
      0);
  for (const char* slip :
       {"analysis.bukling=0", "anlysis.buckling=0", "support.fix=x"}) {
    const reader::CaseReading wrong =
        reader::read_case_text(text, "case.toml", {slip});
    EXPECT_FALSE(wrong.input.has_value()) << slip;
  }
}

// A parameter that study.deviations names scatters like a design variable.
TEST(CaseReader, LetsParametersScatter) {
  const std::string text = changed(
      changed(changed(strut(), "kind = \"match\"\ntargets = { sway = 0.01 }",
                      "kind = \"tolerance\"\ndeviations = { foot = 0.1, load "
                      "= \"20 N\", length = \"0.2 mm\" }"),
              "load = 1000.0", "load = \"1 kN\""),
      "length = 60.0", "length = \"60 mm\"");
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{}, {"load=2 kN"}}) {
    const reader::CaseReading reading =
        reader::read_case_text(text, "case.toml", overrides);
    ASSERT_TRUE(reading.input.has_value()) << reading.problems[0];
    const case_data::Case& input = *reading.input;
    ASSERT_EQ(input.design.size(), 3U);
    EXPECT_TRUE(input.parameters.empty());
    for (std::size_t k = 0; k < 3; ++k) {
      const case_data::DesignVariable& variable = input.design[k];
      const double wanted = variable.name == "foot"   ? 0.1
                            : variable.name == "load" ? 20.0
                                                      : 0.2;
      EXPECT_EQ(input.study.deviations[k], wanted);
      if (variable.name == "load") {
        EXPECT_EQ(variable.initial, overrides.empty() ? 1000.0 : 2000.0);
        EXPECT_EQ(variable.lower, variable.initial);
        EXPECT_EQ(variable.upper, variable.initial);
      }
    }
  }
  EXPECT_THAT(problems_of(changed(text, "length = \"0.2 mm\"", "lenght = 2")),
              Contains(HasSubstr("did you mean 'length'")));
  EXPECT_THAT(problems_of(changed(text, "\"20 N\"", "\"20 mm\"")),
              Contains(AllOf(HasSubstr("study.deviations.load"),
                             HasSubstr("a length; expected a force"))));
  EXPECT_THAT(problems_of(changed(text, "\"60 mm\"", "60.0")),
              Contains(HasSubstr("study.deviations.length is the text "
                                 "'0.2 mm', and 'length' is a plain number")));
}

TEST(CaseReader, ReadsEveryKindOfCurve) {
  const std::string rest = strut_without_head();
  const std::vector<std::string> curves = {
      "kind = \"ellipse\"\ncenter = [0, 0, 60]\nnormal = [0, 0, 1]\n"
      "axis = [1, 0, 0]\nradius_1 = 20\nradius_2 = \"foot\"\n",
      "kind = \"rectangle\"\ncenter = [0, 0, 60]\nnormal = [0, 0, 1]\n"
      "axis = [1, 0, 0]\nwidth = 40\nheight = \"3 cm\"\ncorner_radius = 5\n",
      "kind = \"polygon\"\npoints = [[20, 0, 60], [0, \"foot\", 60], "
      "[-20, 0, 60]]\n"};
  for (const std::string& curve : curves) {
    const reader::CaseReading reading =
        reader::read_case_text(rest + "[curves.head]\n" + curve, "case.toml");
    EXPECT_THAT(reading.problems, IsEmpty()) << curve;
  }
  const case_data::Case input =
      *reader::read_case_text(rest + "[curves.head]\n" + curves[2], "c").input;
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const auto& polygon =
      std::get<curves::Polygon>(inputs.film_system.curves.back().shape);
  ASSERT_EQ(polygon.points.size(), 3U);
  EXPECT_EQ(polygon.points[1], Vec3(0, 25, 60));
}

TEST(CaseReader, ReadsPressuresAndSeveralLoadCases) {
  const case_data::Case input =
      *reader::read_case_text(
           changed(strut(), "[study]",
                   "[load_cases.push]\n"
                   "supports = [{ on = \"foot_pad\", fix = \"z\" }]\n"
                   "loads = [{ on = \"skin\", pressure = \"2 bar\" }]\n"
                   "[responses.peak]\nkind = \"max_von_mises\"\n"
                   "load_case = \"push\"\n[study]"),
           "case.toml")
           .input;
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  EXPECT_EQ(inputs.load_cases[1].pressures[0].pressure, 0.2);
  EXPECT_FALSE(inputs.load_cases[1].supports[0].fix_x);
  EXPECT_TRUE(inputs.load_cases[1].supports[0].fix_z);
  EXPECT_EQ(input.responses.back().load_case, 1);
  EXPECT_EQ(case_data::response_unit(input, 2), "MPa");
}

TEST(CaseReader, TakesTheNearestNestedFilm) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(strut(), "film = 3.0", "film = 2.0"), "case.toml");
  ASSERT_TRUE(reading.input.has_value());
  EXPECT_EQ(reading.input->resolution.film, 1.5);
  EXPECT_EQ(reading.input->resolution.refinements, 2);
  EXPECT_THAT(reading.warnings,
              ElementsAre(AllOf(HasSubstr("warning: resolution.film = 2 is not "
                                          "fea / 2^k"),
                                HasSubstr("1.5 is taken (k = 2)"))));
  const reader::CaseReading near = reader::read_case_text(
      changed(strut(), "film = 3.0", "film = 2.985"), "case.toml");
  EXPECT_EQ(near.input->resolution.film, 3.0);
  EXPECT_THAT(near.warnings, IsEmpty());
}

TEST(CaseReader, WarnsOfWhatIsNotUsed) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(changed(strut(), "load = 1000.0", "load = 1000.0\nspare = 1"),
              "density = 2.8e-9", "density = 0") +
          "[curves.ring]\nkind = \"circle\"\ncenter = [0, 0, 0]\n"
          "normal = [0, 0, 1]\nradius = 1\n"
          "[materials.steel]\nyoungs_modulus = 1\npoisson_ratio = 0\n"
          "density = 1\n",
      "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings,
              ElementsAre(HasSubstr("case.toml:6: warning: parameter 'spare' "
                                    "is not used"),
                          HasSubstr("density is 0; masses will be 0"),
                          HasSubstr("curve 'ring' holds no film or solid"),
                          HasSubstr("material 'steel' fills no body")));
}

const std::string kBellCrank =
    MENISCUS_SOURCE_DIR "/cases/bell_crank/case.toml";

TEST(CaseReader, UsesWhatASwitchedOffStudyUses) {
  const auto warnings = [](std::vector<std::string> overrides) {
    return reader::read_case_file(kBellCrank, std::move(overrides)).warnings;
  };
  EXPECT_THAT(warnings({"study.kind=analyse"}), IsEmpty());
  EXPECT_THAT(warnings({"study.kind=analyse", "study.constraints=[]"}),
              ElementsAre(HasSubstr("parameter 'peak' is not used"),
                          HasSubstr("parameter 'hold' is not used")));
}

TEST(CaseReader, WarnsOfLoadsWithinThePart) {
  const reader::CaseReading reading = reader::read_case_file(
      kBellCrank,
      {"load_cases.service.loads=[{ on = \"b_tip_cap\", force = "
       "[0, 0, \"up * load_a\"] }, { on = \"pin_b\", force = [0, 0, "
       "\"along * load_b\"] }]"});
  EXPECT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings,
              ElementsAre(HasSubstr("the load on 'b_tip_cap' acts within the "
                                    "part: it lies between bodies 'middle_b' "
                                    "and 'end_b'")));
}

TEST(CaseReader, WarnsOfLoadsOnWhatIsHeld) {
  const auto warnings = [](const std::string& force, const std::string& fix) {
    return reader::read_case_text(
               strut(), "case.toml",
               {"load_cases.service.supports=[{ on = \"foot_pad\", fix = "
                "\"xyz\" }, { on = \"head_pad\", fix = \"" +
                    fix + "\" }]",
                "load_cases.service.loads=[{ on = \"head_pad\", force = " +
                    force + " }]"})
        .warnings;
  };
  const auto held =
      ElementsAre(HasSubstr("the load on 'head_pad' moves nothing: load case "
                            "'service' holds that surface "
                            "the way it pushes"));
  EXPECT_THAT(warnings("[\"load\", 0, 0]", "xyz"), held);
  EXPECT_THAT(warnings("[\"load\", 0, 0]", "xz"), held);
  EXPECT_THAT(warnings("[\"load\", \"load\", 0]", "xz"), IsEmpty());
  EXPECT_THAT(warnings("[0, \"load\", 0]", "xz"), IsEmpty());
}

TEST(CaseReader, WarnsOfExpressionsThatMissAResponseOfTheSameName) {
  const auto warnings = [](const std::string& value) {
    return reader::read_case_text(
               changed(strut(), "[study]",
                       "[responses.load]\nkind = \"mass\"\n\n[responses.cost]\n"
                       "kind = \"expression\"\nvalue = \"" +
                           value + "\"\n\n[study]"),
               "case.toml")
        .warnings;
  };
  EXPECT_THAT(warnings("2 * load + sway"),
              ElementsAre(HasSubstr("responses.cost.value takes 'load' of the "
                                    "case, not the response of that name")));
  EXPECT_THAT(warnings("2 * sway"), IsEmpty());
}

TEST(Overrides, ReachParametersDesignAndKeys) {
  const case_data::Case input = reader::read_case(
      two_arm_path(),
      {"load_left=60000", "load_right = 4e4", "support_x=5",
       "resolution.fea=16", "study.method=bobyqa", "bodies.part.volume=1.6e6",
       "materials.aluminium.density=2700 kg/m3", "title=Another",
       "study.max_evaluations=7", "curves.left.center=[-110, 0, 70]",
       "design.support_x.bounds=[-10, 10]", "load_left=50 kN"});
  EXPECT_EQ(input.design[0].initial, 5.0);
  EXPECT_EQ(input.design[0].upper, 10.0);
  EXPECT_EQ(input.resolution.fea, 16.0);
  EXPECT_EQ(input.study.method, "bobyqa");
  EXPECT_EQ(input.study.max_evaluations, 7);
  EXPECT_EQ(input.title, "Another");
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  EXPECT_EQ(inputs.load_cases[0].forces[0].total.z(), -50000.0);
  EXPECT_EQ(inputs.load_cases[0].forces[1].total.z(), -40000.0);
  EXPECT_EQ(inputs.film_system.bodies[0].volume, 1.6e6);
  EXPECT_EQ(inputs.materials[0].density, 2.7e-9);
  const auto& left =
      std::get<curves::Circle>(inputs.film_system.curves[1].shape);
  EXPECT_EQ(left.center, Vec3(-110, 0, 70));
}

std::vector<std::string> override_problems(const std::string& text) {
  return reader::read_case_file(two_arm_path(), {"load_left=1", text}).problems;
}

TEST(Overrides, AreNamedInMessages) {
  EXPECT_THAT(override_problems("load_lefd=1"),
              ElementsAre(HasSubstr("--set load_lefd=1: there is no parameter, "
                                    "design variable or key 'load_lefd'; did "
                                    "you mean 'load_left'?")));
  EXPECT_THAT(override_problems("resolutoin.fea=4"),
              ElementsAre(HasSubstr("did you mean 'resolution.fea'?")));
  EXPECT_THAT(override_problems("bodies.part.volum=1"),
              ElementsAre(AllOf(HasSubstr("--set bodies.part.volum=1"),
                                HasSubstr("did you mean 'volume'?"))));
  EXPECT_THAT(override_problems("support_x=50"),
              ElementsAre(HasSubstr("--set support_x=50: design.support_x."
                                    "initial is 50, outside its bounds")));
  EXPECT_THAT(override_problems("curves.support.radius=0"),
              ElementsAre(HasSubstr("curve 'support': radius is 0")));
  EXPECT_THAT(override_problems("load_right=1/0"),
              ElementsAre(HasSubstr("--set load_right=1/0: parameters."
                                    "load_right: division of 1 by zero")));
  EXPECT_THAT(override_problems("load_right=1,5"),
              ElementsAre(HasSubstr("unexpected ','")));
  EXPECT_THAT(override_problems("load_right"),
              ElementsAre(HasSubstr("--set load_right: expected name=value")));
  EXPECT_THAT(override_problems("=3"),
              ElementsAre(HasSubstr("--set =3: expected name=value")));
  EXPECT_THAT(override_problems("load_right="),
              ElementsAre(HasSubstr("a value is missing")));
  EXPECT_THAT(override_problems("study=3"),
              ElementsAre(HasSubstr("there is no parameter")));
  EXPECT_THAT(override_problems("parameters.load_middle=3"),
              ElementsAre(HasSubstr("there is no parameter")));
  EXPECT_THAT(override_problems("a..b.=3"),
              ElementsAre(HasSubstr("there is no parameter")));
  EXPECT_THAT(override_problems("load_right=1\nload_left=2"),
              ElementsAre(HasSubstr("unexpected '")));
}

TEST(CaseHash, CoversWhatEvaluationsDependOn) {
  const auto hash = [](const std::string& text,
                       const std::vector<std::string>& overrides = {}) {
    const reader::CaseReading reading =
        reader::read_case_text(text, "case.toml", overrides);
    EXPECT_THAT(reading.problems, IsEmpty());
    return reading.input->hash;
  };
  const std::string base = hash(strut());
  EXPECT_EQ(base.size(), 32U);
  // Comments, spacing, writing of numbers, order of tables, path.
  EXPECT_EQ(hash("# hello\n" + strut()), base);
  EXPECT_EQ(hash(changed(strut(), "load = 1000.0", "load   =   1000")), base);
  EXPECT_EQ(
      hash(changed(strut(), "[parameters]\nload = 1000.0\nlength = 60.0", "") +
           "[parameters]\nlength = 60.0\nload = 1000.0\n"),
      base);
  // What no evaluation depends on.
  EXPECT_EQ(hash(changed(strut(), "A strut", "Another strut")), base);
  EXPECT_EQ(hash(strut(), {"study.method=bobyqa", "study.tolerance=1e-5",
                           "study.max_evaluations=3", "resolution.export=[2]"}),
            base);
  // What does count, through the file or through an override.
  EXPECT_EQ(hash(strut() + "[analysis]\nfrequencies = 2\n"), base);
  EXPECT_NE(hash(strut() + "[analysis]\nadapt = true\n"), base);
  EXPECT_NE(hash(changed(strut(), "load = 1000.0", "load = 2000.0")), base);
  EXPECT_EQ(hash(changed(strut(), "load = 1000.0", "load = 2000.0")),
            hash(strut(), {"load=2000"}));
  EXPECT_NE(hash(strut(), {"foot=26"}), base);
  EXPECT_NE(hash(strut(), {"resolution.film=1.5"}), base);
  EXPECT_NE(hash(changed(strut(), "sway = 0.01", "sway = 0.02")), base);
  const std::string foot =
      "[solids.foot_pad]\nkind = \"cap\"\ncurve = \"base\"\n";
  EXPECT_NE(hash(changed(strut(), foot, "") + foot), base)
      << "models follow the order of entries";
}

}  // namespace
}  // namespace meniscus::case_reader_test
