// Walls are meshed, analysed and differentiated like any part.
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/stress/stress.h"
#include "pipeline/case_films/film_start.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "pipeline/forward/part_warnings.h"
#include "pipeline/forward/walls.h"
#include "pipeline/responses/responses.h"
#include "tests/support/case_text.h"
#include "tests/support/more.h"

namespace meniscus::wall_run_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A cylinder by the volume of a void, 30 around, with a wall; ends slide.
std::string cylinder() {
  return R"toml(title = "A pipe"
units = "mm-N-MPa"

[parameters]
inside = 10.0 # MPa
soft = 1e-3

[design.radius]
initial = 30.0
bounds = [28.0, 32.0]

[design.thick]
initial = 6.0
bounds = [5.0, 8.0]

[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = "radius"

[curves.head]
kind = "circle"
center = [0, 0, 20]
normal = [0, 0, 1]
radius = "radius"

[films.skin]
kind = "loft"
curves = ["base", "head"]

[solids.floor]
kind = "cap"
curve = "base"

[solids.lid]
kind = "cap"
curve = "head"

[bodies.gas]
enclosed_by = ["skin", "floor", "lid"]
volume = "20 * pi * radius^2"
material = "void"

[walls.pipe]
films = ["skin"]
thickness = "thick"
material = "steel"

[resolution]
fea = 5.0
film = 2.5

[materials.steel]
youngs_modulus = 2.1e5
poisson_ratio = 0.3
density = 7.8e-9

[load_cases.service]
supports = [
  { on = "skin/rim:base", fix = "normal" },
  { on = "skin/rim:head", fix = "normal" },
  { on = "skin", stiffness = ["soft", "soft", 0] },
]
loads = [{ on = "skin/back", pressure = "inside" }]

[responses.widening]
kind = "mean_displacement"
on = "skin/back"
direction = [1, 0, 0]
weight = "x / sqrt(x^2 + y^2)"

[responses.stress]
kind = "von_mises_norm"
power = 8

[responses.mass]
kind = "mass"

[responses.work]
kind = "compliance"
)toml";
}

std::string fixed_springs(std::string text) {
  return changed(std::move(text), "stiffness = [\"soft\", \"soft\", 0]",
                 "stiffness = [1e-3, 1e-3, 0]");
}

// Lame's cylinder in plane strain, of radius 27 to 33.
TEST(WallRuns, OfAPipeAreLames) {
  constexpr double kMesh = 0.01;  // facets of 9 degrees, one element thick
  const case_data::Case input = case_of(fixed_springs(cylinder()));
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  forward::EvaluationFields fields;
  const forward::Evaluation at =
      model.evaluate(case_data::initial_design(input), &fields);
  ASSERT_FALSE(at.failure) << at.failure->message;
  const double a = 27.0;
  const double b = 33.0;
  const double nu = 0.3;
  const double widening = (1.0 + nu) * 10.0 * a * a /
                          (2.1e5 * (b * b - a * a)) *
                          ((1.0 - 2.0 * nu) * a + b * b / a);
  EXPECT_NEAR(2.0 * at.responses[0], widening, kMesh * widening);
  const double volume = std::numbers::pi * 20.0 * (b * b - a * a);
  EXPECT_NEAR(at.responses[2], 7.8e-9 * volume, kMesh * 7.8e-9 * volume);
  // Of the inside, the largest.
  const double hoop = 10.0 * (a * a + b * b) / (b * b - a * a);
  const double along = nu * (hoop - 10.0);
  const double largest =
      std::sqrt(0.5 * (std::pow(hoop + 10.0, 2) + std::pow(hoop - along, 2) +
                       std::pow(along + 10.0, 2)));
  const stress::StressField stress = stress::recover_stress(
      fields.mesh, fields.inputs.materials, fields.solution.displacements[0]);
  EXPECT_NEAR(stress.max_von_mises, largest, 0.05 * largest);
}

// Whatever the edges, up to twice the wall's thickness.
TEST(WallRuns, HaveTwoElementsAcross) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int trial = 0; trial < more_or(8, 3); ++trial) {
    const double thick = 5.0 + 3.0 * part(random);
    const double edge = thick * (0.6 + 1.4 * part(random));
    SCOPED_TRACE(fmt::format("wall {:.3g}, edge {:.3g}", thick, edge));
    std::string text = fixed_springs(cylinder());
    for (const auto& [from, to] :
         std::vector<std::pair<std::string, std::string>>{
             {"initial = 6.0", fmt::format("initial = {}", thick)},
             {"center = [0, 0, 20]", "center = [0, 0, 80]"},
             {"20 * pi", "80 * pi"},
             {"fea = 5.0", fmt::format("fea = {}", edge)},
             {"film = 2.5", fmt::format("film = {}", edge / 2.0)}}) {
      text = changed(std::move(text), from, to);
    }
    const case_data::Case input = case_of(text);
    const forward::ForwardModel model(input);
    ASSERT_FALSE(model.failure()) << model.failure()->message;
    forward::EvaluationFields fields;
    const forward::Evaluation at =
        model.evaluate(case_data::initial_design(input), &fields);
    ASSERT_FALSE(at.failure) << at.failure->message;
    for (int k = 0; k < 60; ++k) {
      const double angle = 2.0 * std::numbers::pi * part(random);
      const double radius = 30.0 + (k % 2 == 0 ? 0.5 : -0.5) * thick;
      const Vec3 place(radius * std::cos(angle), radius * std::sin(angle),
                       40.0 + 20.0 * (part(random) - 0.5));
      EXPECT_FALSE(stress::one_element_through(fields.mesh, place, 0));
    }
  }
}

// The pressure inside widens the pipe (above), by that name too.
TEST(WallRuns, NameTheirSidesByInsideAndOutside) {
  const auto surface_of = [](const std::string& name) {
    return case_of(changed(cylinder(), "on = \"skin/back\", pressure",
                           "on = \"" + name + "\", pressure"))
        .load_cases[0]
        .loads[0]
        .surfaces.text();
  };
  EXPECT_EQ(surface_of("skin/inside"), "skin/back");
  EXPECT_EQ(surface_of("skin/outside"), "skin");
  EXPECT_EQ(surface_of("skin/back"), "skin/back");
  const std::vector<std::string> problems =
      problems_of(changed(cylinder(), "on = \"skin/back\", pressure",
                          "on = \"skin/insode\", pressure"));
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT(problems[0], testing::HasSubstr("no surface 'skin/insode'"));
  EXPECT_THAT(problems[0], testing::HasSubstr("did you mean 'skin/inside'"));
}

TEST(WallRuns, HaveExactGradients) {
  const case_data::Case input = case_of(
      fixed_springs(changed(changed(cylinder(), "fea = 5.0", "fea = 9.0"),
                            "film = 2.5", "film = 4.5")));
  VectorX design = case_data::initial_design(input);
  design[0] += 0.4;
  design[1] -= 0.3;
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, design);
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
  EXPECT_THAT(check.left_out, IsEmpty());
}

TEST(WallRuns, FollowTheirThickness) {
  const case_data::Case input = case_of(fixed_springs(cylinder()));
  const forward::ForwardModel model(input);
  VectorX design = case_data::initial_design(input);
  const double before = model.evaluate(design).responses[2];
  design[1] = 8.0;
  const double after = model.evaluate(design).responses[2];
  EXPECT_NEAR(after / before, 8.0 / 6.0, 1e-3);
}

// The film that was followed from the design of the freeze before gives a
// crease whose wall crosses itself; the film of first facets does not.
TEST(WallRuns, AreFrozenAnewFromFirstFacetsWhereOthersMakeNoWall) {
  const case_data::Case input = reader::read_case(
      MENISCUS_SOURCE_DIR "/cases/bracket_vs_solid/skin.toml");
  const VectorX before{{-30.313908084589013, 54.0, 58.89485012386359,
                        1.1945374086781442, 3.5601666755839423,
                        5.940604597700847}};
  const VectorX answer{{-32.31312220071308, 54.0, 57.51064240775859,
                        1.2177704500693325, 3.3856092879918407,
                        7.700998812093871}};
  for (const double way : {0.6, 0.8, 0.9, 1.0}) {
    const case_data::Case asked = case_films::frozen_at(
        case_films::frozen_at(input, before), before + way * (answer - before));
    const forward::ForwardModel model(asked);
    EXPECT_FALSE(model.failure()) << way << ": " << model.failure()->message;
  }
}

TEST(WallRuns, TellTheLargestSafeThickness) {
  const std::string text =
      changed(changed(cylinder(), "initial = 6.0", "initial = 70.0"),
              "bounds = [5.0, 8.0]", "bounds = [5.0, 80.0]");
  const case_data::Case input = case_of(fixed_springs(text));
  const forward::ForwardModel model(input);
  ASSERT_TRUE(model.failure());
  EXPECT_EQ(model.failure()->kind, FailureKind::SurfaceInvalid);
  EXPECT_THAT(model.failure()->message, HasSubstr("walls.pipe"));
  EXPECT_THAT(model.failure()->message, HasSubstr("thick at most near ("));
  EXPECT_FALSE(model.findings().empty());
}

void expect_refused(const std::string& text, const std::string& words) {
  const case_data::Case input = case_of(text);
  try {
    const forward::ForwardModel model(input);
    ADD_FAILURE() << "not refused: " << words;
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(WallRuns, NeedAMaterialAndNoSolidBodies) {
  const std::string text = fixed_springs(cylinder());
  expect_refused(changed(text, "thickness = \"thick\"\nmaterial = \"steel\"\n",
                         "thickness = \"thick\"\n"),
                 "walls.pipe has no material");
  expect_refused(changed(text, "material = \"void\"", "material = \"steel\""),
                 "walls.pipe stands beside bodies.gas");
}

TEST(WallRuns, WarnOfWhatTheirProcessCannotMake) {
  const auto warnings = [](const char* least) {
    const case_data::Case input = case_of(
        changed(fixed_springs(cylinder()), "[resolution]",
                "[process]\nname = \"sand casting\"\nsmallest_feature = " +
                    std::string(least) + "\n\n[resolution]"));
    const forward::ForwardModel model(input);
    forward::EvaluationFields fields;
    model.evaluate(case_data::initial_design(input), &fields);
    return forward::process_warnings(input, fields.mesh);
  };
  // Of 6 mm; flat facets of 9 degrees between radii 27 and 33.
  EXPECT_THAT(warnings("5.9"), IsEmpty());
  const std::vector<std::string> thin = warnings("\"7 mm\"");
  ASSERT_EQ(thin.size(), 1U);
  EXPECT_THAT(thin[0], HasSubstr("too thin to be made: "));
  EXPECT_THAT(thin[0], HasSubstr("sand casting makes nothing thinner than 7 "
                                 "mm"));
  EXPECT_THAT(thin[0], HasSubstr("100 % of the surface"));
}

/// A cylinder with a floor across its waist: three films at a circle.
std::string waist() {
  std::string text = fixed_springs(cylinder());
  text =
      changed(text,
              "[films.skin]\nkind = \"loft\"\n"
              "curves = [\"base\", \"head\"]\n",
              "[curves.waist]\nkind = \"circle\"\ncenter = [0, 0, 10]\n"
              "normal = [0, 0, 1]\nradius = 25\n"
              "[films.low]\nkind = \"loft\"\ncurves = [\"base\", \"waist\"]\n"
              "[films.high]\nkind = \"loft\"\n"
              "curves = [\"waist\", \"head\"]\n"
              "[films.floor]\nkind = \"disk\"\ncurves = [\"waist\"]\n");
  const std::size_t from = text.find("[solids.floor]");
  text.erase(from, text.find("[walls.pipe]") - from);
  text = changed(text, "films = [\"skin\"]\nthickness = \"thick\"\n",
                 "films = [\"low\", \"high\"]\nthickness = \"thick / 2\"\n");
  text = changed(text, "[resolution]",
                 "[walls.plate]\nfilms = [\"floor\"]\nthickness = 2\n"
                 "fillet = 2\nmaterial = \"steel\"\n\n[resolution]");
  const std::size_t loads = text.find("supports = [");
  text.erase(loads, text.find("[responses.widening]") - loads);
  text = changed(text, "[responses.widening]",
                 "supports = [{ on = \"low/rim:base\", fix = \"xyz\" }]\n"
                 "loads = [{ on = \"floor\", pressure = 0.1 }]\n\n"
                 "[responses.widening]");
  text = changed(text,
                 "on = \"skin/back\"\ndirection = [1, 0, 0]\n"
                 "weight = \"x / sqrt(x^2 + y^2)\"",
                 "on = \"floor\"\ndirection = [0, 0, 1]");
  return text;
}

TEST(WallRuns, JoinWallsThatMeet) {
  const case_data::Case input = case_of(waist());
  EXPECT_EQ(case_data::solid_bodies(input).size(), 1U);
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  VectorX design = case_data::initial_design(input);
  design[0] = 30.5;
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, design);
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
}

TEST(WallRuns, OfOneBodyHaveOneMaterial) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(changed(waist(), "fillet = 2\nmaterial = \"steel\"",
                      "fillet = 2\nmaterial = \"other\""),
              "[materials.steel]",
              "[materials.other]\nyoungs_modulus = 7e4\npoisson_ratio = 0.3\n"
              "density = 2.8e-9\n\n[materials.steel]"),
      "case.toml");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_THAT(reading.problems[0],
              HasSubstr("walls.pipe and walls.plate meet"));
}

TEST(WallRuns, NameBacksAndRims) {
  const reader::CaseReading reading = reader::read_case_text(
      changed(waist(), "on = \"low/rim:base\"", "on = \"low/rim:waist\""),
      "case.toml");
  ASSERT_FALSE(reading.problems.empty());
  EXPECT_THAT(reading.problems[0], HasSubstr("low/rim:base"));
}

}  // namespace
}  // namespace meniscus::wall_run_test
