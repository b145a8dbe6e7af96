// Solids of kind wetted: faces that films wet on walls.
#include "pipeline/case_data/case_wetted.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/case_data/case_checks.h"
#include "tests/support/case_text.h"

namespace meniscus::case_wetted_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The strut on a foot that slides.
std::string sliding(const std::string& angle = "contact_angle = \"60 deg\"") {
  return changed(strut(), "kind = \"cap\"\ncurve = \"base\"",
                 "kind = \"wetted\"\ncurve = \"base\"\nat = [0, 0, 0]\n"
                 "normal = [0, 0, 1]\n" +
                     angle);
}

TEST(CaseWetted, HasYoungsEnergyAndItsRate) {
  const case_data::Case input = case_of(changed(
      sliding("contact_angle = \"foot / 25\""), "curves = [\"base\", \"head\"]",
      "curves = [\"base\", \"head\"]\ntension = \"foot / 10\""));
  const VectorX design = case_data::initial_design(input);
  const auto wall = case_data::evaluate(input, design).film_system.caps[0].wall;
  ASSERT_TRUE(wall.has_value());
  EXPECT_DOUBLE_EQ(wall->tension, -2.5 * std::cos(1.0));
  const auto rate = case_data::rates(input, design, 0).film_system.caps[0].wall;
  EXPECT_DOUBLE_EQ(rate->tension,
                   -0.1 * std::cos(1.0) + 2.5 * std::sin(1.0) / 25.0);
}

TEST(CaseWetted, MeetsAtARightAngleWhereNoneIsSaid) {
  const case_data::Case input = case_of(sliding(""));
  const auto inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  EXPECT_NEAR(inputs.film_system.caps[0].wall->tension, 0.0, 1e-15);
}

/// A second skin within the first, which slides on the same face.
std::string doubled(const std::string& angle, const std::string& tension) {
  const std::string text = changed(sliding(angle), "curve = \"base\"\nat",
                                   "curve = \"base\"\nholes = [\"hole\"]\nat");
  return changed(
      changed(changed(text, "[solids.foot_pad]",
                      "[curves.hole]\nkind = \"circle\"\n"
                      "center = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 8\n"
                      "[curves.vent]\nkind = \"circle\"\n"
                      "center = [0, 0, \"length\"]\nnormal = [0, 0, 1]\n"
                      "radius = 6\n[films.core]\nkind = \"branch\"\n"
                      "curves = [\"hole\", \"vent\"]\ntension = " +
                          tension + "\n\n[solids.foot_pad]"),
              "curve = \"head\"", "curve = \"head\"\nholes = [\"vent\"]"),
      "[\"skin\", ", "[\"skin\", \"core\", ");
}

void expect_problem(const std::string& text, const std::string& message) {
  const std::vector<std::string> problems = problems_of(text);
  ASSERT_FALSE(problems.empty()) << message;
  EXPECT_THAT(problems[0], HasSubstr(message));
}

TEST(CaseWetted, MistakesAreToldWithTheirLines) {
  const std::string good = sliding();
  EXPECT_THAT(problems_of(good), IsEmpty());
  for (const char* angle : {"0 deg", "180 deg", "-10 deg", "200 deg"}) {
    expect_problem(sliding(std::string("contact_angle = \"") + angle + "\""),
                   "case.toml:33: solids.foot_pad.contact_angle is");
  }
  expect_problem(changed(good, "normal = [0, 0, 1]\ncontact",
                         "normal = [0, 0, 0]\ncontact"),
                 "case.toml:32: solids.foot_pad.normal is 0");
  expect_problem(
      changed(good, "at = [0, 0, 0]", "at = [0, 0, 0.5]"),
      "case.toml:28: curve 'base' is 0.5 off the wall of 'foot_pad'");
  expect_problem(changed(good, "at = [0, 0, 0]", "at = [0, 0, \"foot - 25\"]"),
                 "case.toml:31: solids.foot_pad.at[z] depends on 'foot'");
  expect_problem(
      changed(good, "curves = [\"base\", \"head\"]",
              "curves = [\"base\", \"head\"]\ntension = \"2 + x / 100\""),
      "its tension depends on the place");
  expect_problem(
      changed(good, "[solids.head_pad]",
              "[solids.plug]\nkind = \"ring\"\ncurve = \"base\"\n"
              "inner = \"head\"\n\n[solids.head_pad]"),
      "solid 'foot_pad' is wetted at curve 'base', where skin, plug end; "
      "expected one film there and no other solid");
}

const std::string kShell =
    "[walls.shell]\nfilms = [\"skin\"]\nthickness = 2\n"
    "material = \"aluminium\"\n\n";

TEST(CaseWetted, WallsEndOnPlanesOnly) {
  const auto with_wall = [](const std::string& text) {
    return changed(text, "[solids.foot_pad]", kShell + "[solids.foot_pad]");
  };
  EXPECT_THAT(case_data::wall_surface_names(case_of(with_wall(sliding()))),
              ElementsAre("skin/back", "skin/rim:head", "skin/rim:foot_pad"));
  expect_problem(
      with_wall(changed(changed(sliding(), "normal = [0, 0, 1]\ncontact",
                                "wall = \"sphere\"\nradius = 50\ncontact"),
                        "at = [0, 0, 0]", "at = [0, 0, 43.30127]")),
      "case.toml:28: walls.shell is of a film that slides on the bent wall of "
      "'foot_pad'");
}

/// A film on a triangle in the corner of three planes, of which two are solids
/// and one is of these lines.
std::string corner(const std::string& third) {
  std::string text =
      changed(changed(changed(strut(),
                              "kind = \"circle\"\ncenter = [0, 0, 0]\n"
                              "normal = [0, 0, -1]\nradius = \"foot\"\n",
                              "kind = \"polygon\"\n"
                              "points = [[9, 0, 0], [0, 9, 0], [0, 0, 9]]\n"),
                      "kind = \"branch\"\ncurves = [\"base\", \"head\"]",
                      "kind = \"disk\"\ncurves = [\"base\"]"),
              "[solids.foot_pad]\nkind = \"cap\"\ncurve = \"base\"\n\n"
              "[solids.head_pad]\nkind = \"cap\"\ncurve = \"head\"",
              "[solids.foot_pad]\nkind = \"wetted\"\ncurve = \"base\"\n"
              "at = [0, 0, 0]\nnormal = [0, 0, 1]\n\n"
              "[solids.head_pad]\nkind = \"wetted\"\ncurve = \"base\"\n"
              "at = [0, 0, 0]\nnormal = [0, 1, 0]\n\n" +
                  third);
  text = changed(text, "volume = 9e4", "volume = 300");
  return changed(changed(text, "force = [\"load\", 0, 0]",
                         "force = [0, \"load + foot\", 0]"),
                 "direction = [1, 0, 0]", "direction = [0, 1, 0]");
}

const std::string kThird =
    "[solids.side]\nkind = \"wetted\"\ncurve = \"base\"\n"
    "at = [0, 0, 0]\nnormal = [1, 0, 0]\n\n";

std::string closed_corner(const std::string& third = kThird) {
  return changed(corner(third), "\"head_pad\"]", "\"head_pad\", \"side\"]");
}

TEST(CaseWetted, SolidsAtOnePolygonAreTheWallsOfACell) {
  const case_data::Case input = case_of(closed_corner());
  EXPECT_TRUE(case_data::is_cell(input, "base"));
  EXPECT_FALSE(case_data::is_cell(input, "head"));
  const auto system =
      case_data::evaluate(input, case_data::initial_design(input)).film_system;
  EXPECT_TRUE(system.curves[0].free);
  for (std::size_t k = 0; k < 3; ++k) {
    const films::FilmWall& wall = *system.caps[k].wall;
    EXPECT_TRUE(wall.cuts);
    EXPECT_EQ(wall.tension, 0.0);
    EXPECT_LT(wall.normal.sum(), 0.0);  // away from the triangle
    EXPECT_THAT(system.caps[k].curves(), IsEmpty());
  }
}

TEST(CaseWetted, PlanesOfSymmetryMayBeWallsOfACell) {
  const case_data::Case input =
      case_of(corner("[symmetry]\nplanes = [{ at = [0, 0, 0], "
                     "normal = [-1, 0, 0] }]\n\n"));
  EXPECT_TRUE(case_data::is_cell(input, "base"));
  EXPECT_THAT(input.bodies[0].enclosed_by,
              ElementsAre("skin", "foot_pad", "head_pad", "part/symmetry_1"));
}

TEST(CaseWetted, MistakesOfCellsAreToldWithTheirLines) {
  const std::string good = closed_corner();
  expect_problem(
      changed(good, "[0, 9, 0], ", "[0, 9, 0], [0, 6, 2], [2, 3, 6], "),
      "case.toml:12: side 3 of curve 'base' lies in the plane of "
      "none of the solids that are wetted there");
  expect_problem(
      closed_corner(changed(kThird, "at = [0, 0, 0]", "at = [4, 0, 0]")),
      "curve 'base' lies on both sides of the wall of 'side'");
  expect_problem(
      closed_corner(kThird + "contact_angle = \"80 deg\"\n\n"),
      "solid 'side' is one of the walls of a cell, at curve 'base'; expected "
      "planes without holes, met at 90 deg");
  expect_problem(
      closed_corner(changed(kThird, "at = [0, 0, 0]", "at = [-4, 0, 0]")),
      "no side of curve 'base' lies in the plane of 'side'");
}

/// The strut's foot on a wall of these keys, for the plane's normal.
std::string on_wall(const std::string& keys) {
  return changed(sliding(), "normal = [0, 0, 1]\ncontact", keys + "\ncontact");
}

TEST(CaseWetted, BentWallsHaveTheirPlaceAndSize) {
  const auto wall_of = [](const std::string& keys, const std::string& at) {
    const case_data::Case input =
        case_of(changed(on_wall(keys), "at = [0, 0, 0]", "at = " + at));
    return *case_data::evaluate(input, case_data::initial_design(input))
                .film_system.caps[0]
                .wall;
  };
  const films::FilmWall ball =
      wall_of("wall = \"sphere\"\nradius = \"50 mm\"", "[0, 0, 43.30127]");
  EXPECT_EQ(ball.kind, films::WallKind::Sphere);
  EXPECT_DOUBLE_EQ(ball.radius, 50.0);
  const films::FilmWall cone =
      wall_of("wall = \"cone\"\naxis = [0, 0, -3]\nhalf_angle = \"80 deg\"",
              "[0, 0, 4.4]");
  EXPECT_EQ(cone.kind, films::WallKind::Cone);
  EXPECT_NEAR(cone.half_angle, 4.0 * std::numbers::pi / 9.0, 1e-14);
  EXPECT_NEAR((cone.bent()->axis - Vec3(0, 0, -1)).norm(), 0.0, 1e-15);
  const films::FilmWall tube = wall_of(
      "wall = \"cylinder\"\naxis = [1, 0, 0]\nradius = 300", "[0, 0, 300]");
  EXPECT_EQ(tube.kind, films::WallKind::Cylinder);
}

TEST(CaseWetted, MistakesOfBentWallsAreToldWithTheirLines) {
  expect_problem(on_wall("wall = \"ball\"\nradius = 50"), "case.toml:32: ");
  expect_problem(on_wall("wall = \"sphere\""),
                 "solids.foot_pad has no 'radius'; its wall is a sphere, which "
                 "needs at, radius");
  expect_problem(on_wall("wall = \"sphere\"\nradius = 50\naxis = [0, 0, 1]"),
                 "case.toml:34: solids.foot_pad.axis is of other walls than a "
                 "sphere, which has at, radius; leave it out");
  expect_problem(changed(on_wall("wall = \"sphere\"\nradius = 50"),
                         "at = [0, 0, 0]\n", ""),
                 "solids.foot_pad has no 'at'; its wall is a sphere");
  expect_problem(
      on_wall("wall = \"step\"\nface = \"top\""),
      "has no 'file'; its wall is the face of a STEP file, which needs "
      "file, face");
  expect_problem(on_wall("wall = \"cone\"\naxis = [0, 0, 1]"),
                 "its wall is a cone, which needs at, axis, half_angle");
  expect_problem(
      on_wall("wall = \"cone\"\naxis = [0, 0, 0]\nhalf_angle = \"45 deg\""),
      "case.toml:33: solids.foot_pad.axis is 0; expected a direction along the "
      "wall");
  for (const char* angle : {"0 deg", "90 deg", "-30 deg"}) {
    expect_problem(on_wall(std::string("wall = \"cone\"\naxis = [0, 0, 1]\n"
                                       "half_angle = \"") +
                           angle + "\""),
                   "case.toml:34: solids.foot_pad.half_angle is");
  }
  for (const char* radius : {"0", "-5"}) {
    expect_problem(
        on_wall(std::string("wall = \"sphere\"\nradius = ") + radius),
        "case.toml:33: solids.foot_pad.radius is");
  }
  expect_problem(on_wall("wall = \"sphere\"\nradius = \"2 * foot\""),
                 "case.toml:33: solids.foot_pad.radius depends on 'foot'");
  expect_problem(on_wall("wall = \"sphere\"\nradius = 50"),
                 "curve 'base' is 25 off the wall of 'foot_pad'");
}

TEST(CaseWetted, FilmsOnOneFaceNeedOneEnergyOfIt) {
  const std::string angle = "contact_angle = \"60 deg\"";
  EXPECT_THAT(problems_of(doubled(angle, "1")), IsEmpty());
  EXPECT_THAT(problems_of(doubled("", "2")), IsEmpty());
  expect_problem(doubled(angle, "2"),
                 "films 'skin' and 'core' end on the wall of 'foot_pad' and "
                 "need -0.5 and -1 of energy per area there; give them one "
                 "tension, or a contact angle of 90 deg");
}

}  // namespace
}  // namespace meniscus::case_wetted_test
