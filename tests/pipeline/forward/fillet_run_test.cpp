// Fillets through the whole forward model: a rod on a plate, pulled.
#include <cmath>
#include <numbers>
#include <omp.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/mesh_checks.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/forward/gradient_check.h"
#include "tests/support/case_text.h"
#include "tests/support/rod_on_plate.h"

namespace meniscus::fillet_run_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRodRadius = 8.0;
constexpr double kRodPi = std::numbers::pi;
constexpr double kOfTorus = 0.02;  // four curved facets to its quarter turn

/// "case.toml:N: " of the fillet.
const char* const kFilletLine = "case.toml:44: ";

/// A film in two, from the foot to a waist and on, with a fillet at the waist.
std::string creased_rod_on_plate() {
  std::string text = changed(rod_on_plate(), "[solids.plate]", R"([curves.waist]
kind = "circle"
center = [0, 0, 9]
normal = [0, 0, 1]
radius = 6

[solids.plate])");
  text = changed(text, "curves = [\"foot\", \"head\"]",
                 "curves = [\"foot\", \"waist\"]\n\n[films.upper]\n"
                 "kind = \"loft\"\ncurves = [\"waist\", \"head\"]");
  text = changed(text, "curves = [\"foot\"]\nradius = \"fillet\"",
                 "curves = [\"waist\"]\nradius = \"fillet\"");
  return changed(text, "[\"skin\", ", "[\"skin\", \"upper\", ");
}

Eigen::Vector3d design_of(double fillet, double foot = 8.0, double tilt = 0.0) {
  return {fillet, foot, tilt};
}

TEST(FilletRun, AddsTheMassOfTheTorus) {
  const case_data::Case input =
      case_of(changed(rod_on_plate(), "film = 2.5", "film = 1.25"));
  const forward::ForwardModel model(input);
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const auto exact = [](double r) {
    const double middle =
        kRodRadius + r * (10.0 - 3.0 * kRodPi) / (3.0 * (4.0 - kRodPi));
    return 2.0 * kRodPi * middle * (1.0 - kRodPi / 4.0) * r * r;
  };
  const auto mass = [&](double r) {
    forward::EvaluationFields fields;
    const forward::Evaluation there = model.evaluate(design_of(r), &fields);
    EXPECT_FALSE(there.failure) << there.failure->message;
    EXPECT_THAT(check_surface(fields.boundary), IsEmpty());
    return there.responses[case_data::response_index(input, "mass")];
  };
  const double added = mass(5.0) - mass(2.0);
  EXPECT_NEAR(added / (exact(5.0) - exact(2.0)), 1.0, kOfTorus);
}

TEST(FilletRun, HasExactGradientsByRadiusAndAllElse) {
  const case_data::Case input = case_of(rod_on_plate());
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, design_of(4.6, 8.3, 0.05));
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
  EXPECT_THAT(check.left_out, ElementsAre("peak"));
}

TEST(FilletRun, RoundsTheCreaseBetweenTwoFilms) {
  const case_data::Case input = case_of(creased_rod_on_plate());
  const forward::CaseGradientCheck check =
      forward::check_case_gradient(input, case_data::initial_design(input));
  EXPECT_TRUE(check.report.passed)
      << forward::gradient_check_text(input, check);
}

TEST(FilletRun, LowersThePeakAtTheFoot) {
  std::string text = changed(rod_on_plate(), "initial = 4.0", "initial = 2.0");
  const case_data::Case sharp = case_of(text);
  const case_data::Case round = case_of(rod_on_plate());
  const auto peak = [](const case_data::Case& input) {
    const forward::ForwardModel model(input);
    const forward::Evaluation there =
        model.evaluate(case_data::initial_design(input));
    EXPECT_FALSE(there.failure);
    return there.responses[case_data::response_index(input, "peak")];
  };
  EXPECT_LT(peak(round), 0.95 * peak(sharp));
}

TEST(FilletRun, IsTheSameForAnyNumberOfThreads) {
  const case_data::Case input = case_of(rod_on_plate());
  const int before = omp_get_max_threads();
  const auto responses = [&](int count) {
    omp_set_num_threads(count);
    const forward::ForwardModel model(input);
    return model.evaluate(design_of(4.5, 8.2, 0.02)).responses;
  };
  EXPECT_EQ(responses(1), responses(2));
  omp_set_num_threads(before);
}

TEST(FilletRun, TellsWhatDoesNotFitWithItsLine) {
  const std::string narrow =
      changed(rod_on_plate(), "radius = 24", "radius = 12.5");
  const forward::ForwardModel tight(case_of(changed(narrow, "24^2", "12.5^2")));
  ASSERT_TRUE(tight.failure());
  EXPECT_THAT(tight.failure()->message,
              AllOf(HasSubstr(kFilletLine),
                    HasSubstr("radius 4 does not fit on 'plate/top'")));
  const case_data::Case input = case_of(rod_on_plate());
  const forward::ForwardModel model(input);
  const forward::Evaluation large = model.evaluate(design_of(12.0));
  ASSERT_TRUE(large.failure);
  EXPECT_EQ(large.failure->kind, FailureKind::SurfaceInvalid);
  EXPECT_THAT(large.failure->message,
              AllOf(HasSubstr(kFilletLine),
                    HasSubstr("a ball of radius 12 does not fit in the corner"),
                    HasSubstr("a model frozen nearer to this design")));
  const forward::ForwardModel huge(
      case_of(changed(rod_on_plate(), "radius = \"fillet\"", "radius = 1e6")));
  ASSERT_TRUE(huge.failure());
  EXPECT_THAT(huge.failure()->message,
              AllOf(HasSubstr(kFilletLine),
                    HasSubstr("radius 1e+06 has no room in a part of size")));
}

/// A waist of radius 8 between two plates, 16 apart.
std::string waist_between_plates() {
  std::string text =
      changed(rod_on_plate(), "[\"20 * tilt\", 0, 20]", "[0, 0, 16]");
  text = changed(text, "[\"tilt\", 0, 1]", "[0, 0, 1]");
  text = changed(text, "kind = \"cap\"\ncurve = \"head\"",
                 "kind = \"flange\"\nat = [0, 0, 16]\naxis = [0, 0, -1]\n"
                 "radius = 24\nthickness = 5\ncurves = [\"head\"]");
  text = changed(text, "curves = [\"foot\"]\nradius = \"fillet\"",
                 "curves = [\"foot\", \"head\"]\nradius = 6.8");
  text = changed(text, "8^2 * 20 + 24^2 * 5", "0.85 * 8^2 * 16 + 2 * 24^2 * 5");
  return changed(text, "on = \"end\"", "on = \"end/bottom\"");
}

// The film bends away from the planes by which room was found.
TEST(FilletRun, AFreezeDoesNotAdviseAnotherFreeze) {
  const forward::ForwardModel model(case_of(waist_between_plates()));
  ASSERT_TRUE(model.failure());
  EXPECT_THAT(model.failure()->message,
              AllOf(HasSubstr("a ball of radius 6.8 does not fit"),
                    HasSubstr("'foot'; make the radius smaller")));
}

TEST(FilletRun, RefusesWhatItCannotRound) {
  const std::string fillet = "curves = [\"foot\"]\nradius = \"fillet\"";
  EXPECT_THAT(problems_of(changed(rod_on_plate(), fillet,
                                  "curves = [\"plate/edge\"]\nradius = 1")),
              ElementsAre(AllOf(
                  HasSubstr("case.toml:45: "),
                  HasSubstr("there is no curve of a film 'plate/edge'"))));
  EXPECT_THAT(problems_of(changed(rod_on_plate(), fillet,
                                  "curves = [\"foot\", \"foot\"]\nradius = 1")),
              ElementsAre(HasSubstr("a curve has one radius")));
  EXPECT_THAT(
      problems_of(changed(rod_on_plate(), "initial = 4.0", "initial = 0.0")),
      Contains(AllOf(HasSubstr("case.toml:46: "),
                     HasSubstr("begin with a radius above 0"))));
  EXPECT_THAT(problems_of(changed(rod_on_plate(), fillet,
                                  "curves = [\"foot\"]\nradius = -1")),
              ElementsAre(HasSubstr("0 or above")));
  EXPECT_THAT(problems_of(changed(rod_on_plate(), fillet,
                                  "curves = [\"foot\"]\nradius = 1e-3")),
              ElementsAre(AllOf(HasSubstr("case.toml:46: "),
                                HasSubstr("go 1.5e+05 times around 'foot'"))));
}

/// Two rods on the plate, which grow and may move.
std::string two_rods(const std::string& x) {
  std::string text = changed(rod_on_plate(), "[solids.plate]", R"([curves.other]
kind = "circle"
center = [)" + x + R"(, 0, 0]
normal = [0, 0, 1]
radius = "foot / 4"

[curves.other_head]
kind = "circle"
center = [)" + x + R"(, 0, 20]
normal = [0, 0, 1]
radius = 2

[films.other]
kind = "loft"
curves = ["other", "other_head"]

[solids.other_end]
kind = "cap"
curve = "other_head"

[solids.plate])");
  text = changed(text, "curves = [\"foot\"]\n\n[solids.end]",
                 "curves = [\"foot\", \"other\"]\n\n[solids.end]");
  return changed(text, "[\"skin\", ", "[\"skin\", \"other\", \"other_end\", ");
}

TEST(RimsOfOneFace, TellThatTheyHaveMerged) {
  const case_data::Case input = case_of(two_rods("17"));
  const auto problems = [&](double foot) {
    std::vector<std::string> found;
    case_data::evaluate(input, design_of(4.0, foot), found);
    return found;
  };
  EXPECT_THAT(problems(9.0), IsEmpty());
  EXPECT_THAT(problems(15.0),
              ElementsAre(AllOf(HasSubstr("curves 'foot' and 'other' meet"),
                                HasSubstr("rims of 'plate/top' have merged"))));
  // In one step from beside to within.
  EXPECT_THAT(problems(23.0),
              ElementsAre(AllOf(HasSubstr("curves 'foot' and 'other', rims of "
                                          "'plate/top', have merged"),
                                HasSubstr("'other' lies within 'foot'"))));
}

TEST(RimsOfOneFace, FailADesignOfAStudy) {
  const forward::ForwardModel model(case_of(changed(
      rod_on_plate(), "thickness = 5\n",
      "thickness = 5\nhole_centers = [[18, 0, 0]]\nhole_radius = 1.5\n")));
  ASSERT_FALSE(model.failure()) << model.failure()->message;
  const forward::Evaluation there = model.evaluate(design_of(4.0, 18.0));
  ASSERT_TRUE(there.failure);
  EXPECT_THAT(there.failure->message,
              AllOf(HasSubstr("'foot'"), HasSubstr("'plate/hole_1'"),
                    HasSubstr("rims of 'plate/top' have merged")));
}

TEST(RimsOfOneFace, AreToldInCheckToo) {
  EXPECT_THAT(problems_of(two_rods("9")),
              Contains(HasSubstr("rims of 'plate/top' have merged")));
}

}  // namespace
}  // namespace meniscus::fillet_run_test
