// Cases that draw a half, a quarter or an eighth of a part.
#include "pipeline/case_data/case_symmetry.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/case_text.h"

namespace meniscus::case_symmetry_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kPlane = "{ at = [0, 0, 0], normal = [0, 0, -1] }";

/// The strut's upper half, whose film begins on its base and slides there.
std::string half(const std::string& planes = kPlane) {
  std::string text =
      changed(strut(), "[curves.base]",
              "[symmetry]\nplanes = [" + planes + "]\n\n[curves.base]");
  text = changed(text, "[solids.foot_pad]\nkind = \"cap\"\ncurve = \"base\"\n",
                 "");
  text = changed(text, "\"skin\", \"foot_pad\"", "\"skin\"");
  text = changed(text, "{ on = \"foot_pad\", fix = \"xyz\" }",
                 "{ on = \"head_pad\", fix = \"xy\" }");
  text = changed(text, "[\"load\", 0, 0]", "[0, 0, \"load\"]");
  text = changed(text, "direction = [1, 0, 0]", "direction = [0, 0, 1]");
  return changed(text, "sway = 0.01", "sway = 0.01, mass = 1e-4") +
         "[analysis]\nbuckling = 0\n";
}

TEST(CaseSymmetry, ClosesAndHoldsWhatEndsInThePlane) {
  const case_data::Case input = case_of(half());
  EXPECT_EQ(case_data::symmetric_parts(input), 2);
  EXPECT_THAT(case_data::cut_faces(input), ElementsAre("part/symmetry_1"));
  EXPECT_THAT(input.bodies[0].enclosed_by,
              ElementsAre("skin", "head_pad", "part/symmetry_1"));
  const auto inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const auto& supports = inputs.load_cases[0].supports;
  ASSERT_EQ(supports.size(), 2U);
  EXPECT_EQ(supports[1].surface, "part/symmetry_1");
  EXPECT_EQ(supports[1].kind, loads::SupportKind::Symmetry);
  const auto& cap = inputs.film_system.caps.back();
  ASSERT_TRUE(cap.wall.has_value());
  EXPECT_NEAR(cap.wall->tension, 0.0, 1e-15);
  EXPECT_EQ(input.responses[0].images, 1);
  EXPECT_EQ(input.responses[1].images, 2);
}

/// Whose film a solid in the plane holds.
std::string held_half() {
  return changed(changed(half(), "[\"skin\", ", "[\"skin\", \"foot_pad\", "),
                 "[solids.head_pad]",
                 "[solids.foot_pad]\nkind = \"cap\"\ncurve = \"base\"\n\n"
                 "[solids.head_pad]");
}

TEST(CaseSymmetry, ASolidOfTheCaseInThePlaneIsACutFaceToo) {
  const case_data::Case input = case_of(held_half());
  EXPECT_THAT(case_data::cut_faces(input), ElementsAre("foot_pad"));
  EXPECT_THAT(input.bodies[0].enclosed_by,
              ElementsAre("skin", "foot_pad", "head_pad"));
}

TEST(CaseSymmetry, EndsOfWallsAreHeldInThePlane) {
  const std::string wall =
      "[walls.shell]\nfilms = [\"skin\"]\nthickness = 2\n"
      "material = \"aluminium\"\n\n[solids.head_pad]";
  const std::string text =
      changed(changed(changed(half(), "[solids.head_pad]", wall),
                      "material = \"aluminium\"\n\n[resolution]",
                      "material = \"void\"\n\n[resolution]"),
              "{ on = \"head_pad\", force", "{ on = \"skin/rim:head\", force");
  const case_data::Case input = case_of(changed(
      changed(text, "{ on = \"head_pad\", fix = \"xy\" }",
              "{ on = \"skin/rim:head\", fix = \"xy\" }"),
      "on = \"head_pad\"\ndirection", "on = \"skin/rim:head\"\ndirection"));
  EXPECT_THAT(case_data::wall_ends(input, 0), ElementsAre("skin/symmetry_1"));
  const auto& supports = input.load_cases[0].supports;
  ASSERT_EQ(supports.size(), 2U);
  EXPECT_EQ(supports[1].support.surface, "skin/symmetry_1");
  EXPECT_EQ(supports[1].support.kind, loads::SupportKind::Symmetry);
  EXPECT_THAT(case_data::cuts_of_whole(input, 0),
              ElementsAre("part/symmetry_1", "part/symmetry_1/image",
                          "skin/symmetry_1", "skin/symmetry_1/image"));
  EXPECT_THAT(
      problems_of(changed(held_half(), "[solids.head_pad]", wall)).at(0),
      HasSubstr("walls.shell is of a film that solid 'foot_pad' holds in plane "
                "1 of symmetry; take 'foot_pad' out"));
}

TEST(CaseSymmetry, WarnsOfMotionsThatAreNotSymmetric) {
  const auto warnings = reader::read_case_text(half(), "case.toml").warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("case.toml:13: warning: the films are "
                                     "judged for motions that are symmetric"));
}

void expect_problem(const std::string& text, const std::string& message) {
  const std::vector<std::string> problems = problems_of(text);
  ASSERT_FALSE(problems.empty()) << message;
  EXPECT_THAT(problems[0], HasSubstr(message));
}

TEST(CaseSymmetry, PlanesThatAreNoneAreToldWithTheirLines) {
  EXPECT_THAT(problems_of(half()), IsEmpty());
  expect_problem(half("{ at = [0, 0, 0], normal = [0, 0, 0] }"),
                 "case.toml:13: symmetry.planes: normal is 0");
  expect_problem(
      half(std::string(kPlane) + ", { at = [30, 0, 0], normal = [1, 0, 1] }"),
      "case.toml:13: planes 1 and 2 of symmetry meet at 45 deg; expected 90");
  expect_problem(half("{ at = [0, 0, 0] }"), "case.toml:13: ");
  expect_problem(
      half(std::string(kPlane) + ", { at = [99, 0, 0], normal = [1, 0, 0] }, "
                                 "{ at = [0, 99, 0], normal = [0, 1, 0] }, "
                                 "{ at = [0, 99, 0], normal = [0, 1, 0] }"),
      "symmetry has 4 planes; expected one to three");
}

TEST(CaseSymmetry, CurvesBeyondAPlaneAreToldWithTheirLines) {
  // The other side, across, and a rim that only touches it.
  expect_problem(half("{ at = [0, 0, 0], normal = [0, 0, 1] }"),
                 "case.toml:21: curve 'head' is 60 beyond plane 1");
  expect_problem(
      half(std::string(kPlane) + ", { at = [5, 0, 0], normal = [1, 0, 0] }"),
      "case.toml:15: curve 'base' crosses plane 2 of symmetry and is not its "
      "own image there: it is 20 off");
  expect_problem(
      half(std::string(kPlane) + ", { at = [25, 0, 0], normal = [1, 0, 0] }"),
      "case.toml:15: curve 'base', which holds a film, touches plane "
      "2");
  expect_problem(changed(half(), "center = [0, 0, 0]",
                         "center = [0, 0, \"(foot - 25) / 10\"]"),
                 "with 'foot' at the end of its bounds");
  expect_problem(half("{ at = [0, 0, -9], normal = [0, 0, -1] }"),
                 "body 'part' is not closed at curve 'base'");
}

// A hole's rim, which no film holds, would meet its image there too.
TEST(CaseSymmetry, SmoothRimsThatTouchAPlaneAreTold) {
  std::string text = changed(half(), "curve = \"head\"",
                             "curve = \"head\"\nholes = [\"hole\"]");
  text = changed(text, "[films.skin]",
                 "[curves.hole]\nkind = \"circle\"\n"
                 "center = [0, 2, \"length\"]\nnormal = [0, 0, 1]\n"
                 "radius = 3\n\n[solids.plug]\nkind = \"cap\"\n"
                 "curve = \"hole\"\n\n[films.skin]");
  text = changed(text, "[\"skin\", ", "[\"skin\", \"plug\", ");
  const std::string plane = "normal = [0, 0, -1] }";
  text =
      changed(text, plane, plane + ", { at = [0, 5, 0], normal = [0, 1, 0] }");
  EXPECT_THAT(problems_of(text),
              Contains(HasSubstr("curve 'hole' touches plane 2 of symmetry")));
}

/// The whole strut, which a plane along its axis cuts; the force lies in it.
std::string cut_strut() {
  std::string text = changed(strut(), "[curves.base]",
                             "[symmetry]\nplanes = [{ at = [0, 0, 0], normal = "
                             "[0, 2, 0] }]\n\n[curves.base]");
  return changed(text, "sway = 0.01", "sway = 0.01, mass = 1e-4") +
         "[analysis]\nbuckling = 0\n";
}

TEST(CaseSymmetry, APlaneCutsCurvesThatAreDrawnWhole) {
  const case_data::Case input = case_of(cut_strut());
  EXPECT_THAT(case_data::cut_faces(input), ElementsAre("part/symmetry_1"));
  EXPECT_THAT(input.bodies[0].enclosed_by,
              ElementsAre("skin", "foot_pad", "head_pad", "part/symmetry_1"));
  const auto inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const films::CapSpec& cap = inputs.film_system.caps.back();
  EXPECT_THAT(cap.curves(), IsEmpty());
  ASSERT_TRUE(cap.wall.has_value());
  EXPECT_TRUE(cap.wall->cuts);
  EXPECT_EQ(inputs.load_cases[0].supports.back().surface, "part/symmetry_1");
  EXPECT_EQ(input.responses[1].images, 2);
}

TEST(CaseSymmetry, CurvesThatAPlaneCutsWronglyAreTold) {
  const std::string head = "center = [0, 0, \"length\"]";
  EXPECT_THAT(problems_of(cut_strut()), IsEmpty());
  expect_problem(changed(cut_strut(), head, "center = [0, 1, \"length\"]"),
                 "curve 'head' crosses plane 1 of symmetry and is not its own "
                 "image there: it is 4 off");
  // Only at another design, and of a circle that turns in the plane.
  expect_problem(changed(cut_strut(), head,
                         "center = [0, \"(foot - 25) / 10\", \"length\"]"),
                 "curve 'head' crosses plane 1 of symmetry and is not");
  expect_problem(changed(cut_strut(), head + "\nnormal = [0, 0, 1]",
                         head + "\nnormal = [\"(foot - 25) / 10\", 0, 1]"),
                 "curve 'head' crosses plane 1 of symmetry at other places of "
                 "its own than at the initial design");
  expect_problem(
      changed(cut_strut(), head, "center = [0, \"foot - 50\", \"length\"]"),
      "curve 'head' is 2 beyond plane 1 of symmetry");
}

TEST(CaseSymmetry, CurvesThatPassAPlaneMoreThanTwiceAreToldSo) {
  const std::string head =
      "kind = \"circle\"\ncenter = [0, 0, \"length\"]\nnormal = [0, 0, "
      "1]\nradius = 20";
  expect_problem(
      changed(cut_strut(), head,
              "kind = \"polygon\"\npoints = [[-20, -20, 60], [20, -20, 60], "
              "[20, 20, 60], [10, 20, 60], [10, -10, 60], [-10, -10, 60], "
              "[-10, 20, 60], [-20, 20, 60]]"),
      "curve 'head' passes plane 1 of symmetry at 4 places of its own; "
      "expected two");
}

TEST(CaseSymmetry, CurvesThatHoldNothingMayCrossAPlane) {
  EXPECT_THAT(problems_of(changed(cut_strut(), "[films.skin]",
                                  "[curves.pattern]\nkind = \"circle\"\n"
                                  "center = [0, 3, 9]\nnormal = [0, 0, 1]\n"
                                  "radius = 5\n\n[films.skin]")),
              IsEmpty());
}

TEST(CaseSymmetry, LoadsOnWhatAPlaneCutsHaveHalvesOfTheWholes) {
  const auto loaded = [&](const std::string& more) {
    return changed(cut_strut(), "loads = [", "loads = [" + more + ", ");
  };
  for (const char* good : {"{ on = \"head_pad\", force = [3, 0, 1] }",
                           "{ on = \"skin\", pressure = \"x\" }",
                           "{ on = \"skin\", traction = [0, 1, 0] }"}) {
    EXPECT_THAT(problems_of(loaded(good)), IsEmpty()) << good;
  }
  expect_problem(loaded("{ on = \"head_pad\", force = [0, 1, 5] }"),
                 "a force across it on a surface that plane 1 of symmetry "
                 "cuts");
  for (const char* bad :
       {"{ on = \"head_pad\", force = [1, 0, 0], at = [0, 0, 60] }",
        "{ on = \"head_pad\", force = [1, 0, 0], by = \"rigid\" }",
        "{ on = \"head_pad\", moment = [0, 1, 0], at = [0, 0, 60] }"}) {
    expect_problem(loaded(bad),
                   "a moment, a preload or a force with 'at' or 'by' on a "
                   "surface that plane 1 of symmetry cuts");
  }
  expect_problem(changed(cut_strut(), "[bodies.part]",
                         "[fillets.root]\ncurves = [\"head\"]\nradius = "
                         "2\n\n[bodies.part]"),
                 "a fillet along a curve that plane 1 of symmetry cuts");
}

TEST(CaseSymmetry, WhatIsNotSymmetricIsTold) {
  const std::string load = "loads = [";
  const auto loaded = [&](const std::string& more) {
    return changed(half(), load, load + more + ", ");
  };
  expect_problem(loaded("{ on = \"part/symmetry_1\", pressure = 1 }"),
                 "a load on 'part/symmetry_1', which lies in a plane of "
                 "symmetry");
  expect_problem(changed(half(), "supports = [",
                         "supports = [{ on = \"part/symmetry_1\", fix = "
                         "\"x\" }, "),
                 "a support on 'part/symmetry_1'");
  expect_problem(loaded("{ gravity = [0, 0, -9810] }"),
                 "gravity across plane 1 of symmetry");
  EXPECT_THAT(problems_of(loaded("{ gravity = [0, -9810, 0] }")), IsEmpty());
  expect_problem(loaded("{ spin = 3, axis = [1, 0, 0], at = [0, 0, 9] }"),
                 "a spin about an axis that is not symmetric about plane 1");
  EXPECT_THAT(
      problems_of(loaded("{ spin = 3, axis = [1, 0, 0], at = [9, 0, 0] }")),
      IsEmpty());
  EXPECT_THAT(
      problems_of(loaded("{ spin = 3, axis = [0, 0, 1], at = [9, 0, 9] }")),
      IsEmpty());
  expect_problem(changed(half(), "force = [0, 0, \"load\"]",
                         "size = \"load\", at = [0, 0, 60]"),
                 "a load of given 'size'");
}

TEST(CaseSymmetry, FilletsAreOfCurvesOutsideThePlanes) {
  const auto rounded = [](const std::string& curve) {
    return changed(held_half(), "[bodies.part]",
                   "[fillets.root]\ncurves = [\"" + curve +
                       "\"]\nradius = 2\n\n[bodies.part]");
  };
  EXPECT_THAT(problems_of(rounded("head")), IsEmpty());
  expect_problem(rounded("base"),
                 "a fillet along 'base', which lies in plane 1 of symmetry");
}

TEST(CaseSymmetry, ResponsesThatAHalfHasNotAreTold) {
  const auto asked = [](const std::string& response) {
    return changed(half(), "[study]",
                   "[responses.more]\n" + response + "\n\n[study]");
  };
  for (const char* bad :
       {"kind = \"centre_of_mass\"\ndirection = [0, 0, 1]",
        "kind = \"inertia\"\naxis = [1, 0, 0]",
        "kind = \"inertia\"\naxis = [1, 0, 0]\nthrough = [0, 0, 30]",
        "kind = \"inertia\"\naxis = [1, 0, 1]",
        "kind = \"overhang\"\ndirection = [0, 0, 1]",
        "kind = \"draft\"\non = \"skin\"\ndirection = [1, 0, 1]"}) {
    expect_problem(asked(bad),
                   "responses.more is of the whole, and its "
                   "direction is not symmetric about plane 1");
  }
  for (const char* good :
       {"kind = \"centre_of_mass\"\ndirection = [0, 1, 0]",
        "kind = \"inertia\"\naxis = [0, 0, 1]",
        "kind = \"inertia\"\naxis = [1, 0, 0]\nthrough = [0, 0, 0]",
        "kind = \"overhang\"\ndirection = [0, 1, 0]",
        "kind = \"draft\"\non = \"skin\"\ndirection = [1, 0, 0]"}) {
    EXPECT_THAT(problems_of(asked(good)), IsEmpty()) << good;
  }
  expect_problem(asked("kind = \"thickness\""),
                 "thickness is from face to face");
  expect_problem(asked("kind = \"draft\"\ndirection = [1, 0, 0]"),
                 "draft needs 'on'");
  expect_problem(asked("kind = \"frequency\"\nload_case = \"free\""),
                 "a part that is free cannot be with [symmetry]");
  expect_problem(changed(half(), "[resolution]",
                         "[process]\nsmallest_feature = 3\n\n[resolution]"),
                 "process.smallest_feature");
}

}  // namespace
}  // namespace meniscus::case_symmetry_test
