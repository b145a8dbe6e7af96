// Curve kinds from case file to numbers, and their refusals.
#include <array>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "evolve/frozen/film_model.h"
#include "pipeline/files/curve_file.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/store/stored_case.h"
#include "tests/support/temp_folder.h"

namespace meniscus::case_curves_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kHalfTurn = std::numbers::pi;

/// A wall of a disk over the curve `rim`, which `curves` defines; its first
/// line is line 10.
std::string disk(const std::string& curves) {
  return R"(title = "A disk"
units = "mm-N-MPa"
[parameters]
turn = 0.5
[design.width]
initial = 3.0
bounds = [2.0, 4.0]
[design.height]
initial = 2.0
bounds = [1.5, 2.5]
)" + curves +
         R"([films.skin]
kind = "disk"
curves = ["rim"]
[walls.web]
films = ["skin"]
thickness = 0.1
[resolution]
fea = 1.0
)";
}

case_data::Case case_of(const std::string& text) {
  const reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  return reading.input ? *reading.input : case_data::Case{};
}

std::vector<std::string> problems_of(const std::string& text) {
  return reader::read_case_text(text, "case.toml").problems;
}

/// Points of every curve, by both design variables, against differences.
void expect_rates(const case_data::Case& input) {
  constexpr double kStep = 1e-5;
  constexpr double kDifference = 1e-8;  // of central differences
  const VectorX design = case_data::initial_design(input);
  const case_data::EvaluatedCase here = case_data::evaluate(input, design);
  for (int j = 0; j < design.size(); ++j) {
    const case_data::CaseRates rate = case_data::rates(input, design, j);
    VectorX less = design;
    VectorX more = design;
    less[j] -= kStep;
    more[j] += kStep;
    const case_data::EvaluatedCase a = case_data::evaluate(input, less);
    const case_data::EvaluatedCase b = case_data::evaluate(input, more);
    for (std::size_t c = 0; c < here.film_system.curves.size(); ++c) {
      const auto shape = [&](const case_data::StageInputs& inputs) {
        return inputs.film_system.curves[c].shape;
      };
      for (const double t : {0.0, 0.21, 0.5, 0.83}) {
        const Vec3 difference =
            (curves::point_at(shape(b), t) - curves::point_at(shape(a), t)) /
            (2.0 * kStep);
        EXPECT_LT((curves::point_rate(shape(here), shape(rate), t) - difference)
                      .norm(),
                  kDifference * std::max(1.0, difference.norm()))
            << here.film_system.curves[c].name << " at " << t;
      }
    }
  }
}

const char* const kSpline = R"([curves.rim]
kind = "spline"
points = [["width", 0, 0], [0, "height", 0], ["-width", 0, "turn"], [0, -2, 0]]
)";

const char* const kSlot = R"([curves.rim]
kind = "polyline"
points = [
  ["-width", "-height", 0], ["width", "-height", 0],
  { through = ["width + height", 0, 0] },
  ["width", "height", 0], ["-width", "height", 0],
  { through = ["-width - height", 0, 0] },
]
)";

const char* const kCopies = R"([curves.seed]
kind = "ellipse"
center = [1, 0, 0]
normal = [0, 0, 1]
axis = [1, 0, 0]
radius_1 = "width"
radius_2 = "height"
[curves.rim]
kind = "copy"
of = "seed"
offset = "-0.1 * height"
scales = [1, "width / 2", 1]
mirror = [0, 1, 0]
rotate = "turn * width"
axis = [0, 1, 1]
about = [0, "height", 0]
move = [0, 0, "5 * width"]
)";

TEST(CaseCurves, OfEveryKindFollowTheDesignWithExactRates) {
  for (const char* text : {kSpline, kSlot, kCopies}) {
    const case_data::Case input = case_of(disk(text));
    ASSERT_FALSE(input.curves.empty());
    expect_rates(input);
  }
  const case_data::Case slot = case_of(disk(kSlot));
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(slot, case_data::initial_design(slot));
  EXPECT_NEAR(curves::length_of(inputs.film_system.curves[0].shape),
              12.0 + 4.0 * kHalfTurn, 1e-12);
}

TEST(CaseCurves, RepeatCountsInExpressions) {
  const case_data::Case input = case_of(disk(R"([curves.hole]
kind = "circle"
center = ["10 * i", "width * j", 0]
normal = [0, 0, 1]
radius = "1 / i"
repeat = [2, 3]
[curves.rim]
kind = "copy"
of = "hole_2_3"
move = [0, 0, 1]
)"));
  std::vector<std::string> names;
  for (const case_data::CurveEntry& curve : input.curves) {
    names.push_back(curve.name);
  }
  EXPECT_THAT(names, ElementsAre("hole_1_1", "hole_1_2", "hole_1_3", "hole_2_1",
                                 "hole_2_2", "hole_2_3", "rim"));
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const curves::Circle& hole =
      std::get<curves::Circle>(inputs.film_system.curves[5].shape);
  EXPECT_EQ(hole.center, Vec3(20, 9, 0));
  EXPECT_EQ(hole.radius, 0.5);
  expect_rates(input);
}

TEST(CaseCurves, ComeFromFilesThatBelongToTheCase) {
  const TempFolder folder;
  const auto path = (folder / "case.toml").string();
  write_file(path, disk("[curves.rim]\nkind = \"file\"\nfile = \"rim.csv\"\n"));
  write_file(folder / "rim.csv",
             "Y,name,x [cm],z\n0,a,1,0\n10,b,0,0\n0,c,-1,0.5\n-10,d,0,0\n"
             "0,a,1,0\n");
  const case_data::Case first = reader::read_case(path);
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(first, case_data::initial_design(first));
  const curves::Spline& rim =
      std::get<curves::Spline>(inputs.film_system.curves[0].shape);
  ASSERT_EQ(rim.points.size(), 4U);  // the last one closes
  EXPECT_EQ(rim.points[2], Vec3(-10, 0, 0.5));
  expect_rates(first);
  const std::string stored = store::stored_case(first);
  write_file(folder / "rim.csv", "x,y,z\n1,0,0\n0,1,0\n-1,0,0\n");
  EXPECT_NE(reader::read_case(path).hash, first.hash);
  std::filesystem::remove(folder / "rim.csv");
  const case_data::Case again = store::restore_case({.case_text = stored});
  EXPECT_EQ(again.hash, first.hash);
  EXPECT_EQ(again.curves[0].fixed_points, first.curves[0].fixed_points);
  EXPECT_THAT(
      reader::read_case_file(path).problems,
      ElementsAre(AllOf(HasSubstr("case.toml:13: curves.rim.file: "),
                        HasSubstr("there is no file"), HasSubstr("rim.csv"))));
}

std::string file_problem(const std::string& text) {
  const files::CurveFile file =
      files::read_curve_text(text, "rim.csv", *unit_system("mm-N-MPa"));
  return file.problems.empty() ? "" : file.problems.front();
}

TEST(CurveFiles, AreRefusedByLine) {
  EXPECT_THAT(file_problem(""), HasSubstr("rim.csv:1: the file is empty"));
  EXPECT_THAT(file_problem("x,y\n1,2\n"),
              HasSubstr("rim.csv:1: no column 'z' in the head row"));
  EXPECT_THAT(file_problem("1,2,3\n4,5,6\n"), HasSubstr("no column 'x'"));
  EXPECT_THAT(file_problem("x,y,z\n1,2,3\n1,b,3\n"),
              HasSubstr("rim.csv:3: column y is 'b'; expected a number"));
  EXPECT_THAT(file_problem("x,y,z\n1,2,3\n1,nan,3\n"),
              HasSubstr("rim.csv:3: column y is 'nan'"));
  EXPECT_THAT(file_problem("x,y,z\n1,2,3\n1,2\n"),
              HasSubstr("rim.csv:3: 2 cells in this row and 3"));
  EXPECT_THAT(file_problem("x,y,z\n1,2,3\n1,2,3\n"),
              HasSubstr("rim.csv:3: the same point"));
  EXPECT_THAT(file_problem("x,y,z\n1,2,3\n2,2,3\n1,2,3\n"),
              HasSubstr("2 points; a closed curve needs three"));
  EXPECT_THAT(file_problem("x [kg],y,z\n1,2,3\n"), HasSubstr("rim.csv:1: "));
  EXPECT_THAT(file_problem(std::string("\x89PNG\r\n\x1a\n") + '\0' + '\xff'),
              HasSubstr("no column"));
}

TEST(CaseCurves, ThatAreWrongAreRefusedByLine) {
  EXPECT_THAT(problems_of(disk("[curves.rim]\nkind = \"polygon\"\npoints = "
                               "[[0,0,0], [3,2,0], [3,0,0], [0,1,0]]\n")),
              ElementsAre(AllOf(HasSubstr("case.toml:11: curve 'rim': crosses "
                                          "or touches itself near (1, 0.6667"),
                                HasSubstr("follow each other"))));
  EXPECT_THAT(
      problems_of(disk("[curves.rim]\nkind = \"spline\"\npoints = "
                       "[[0,0,0], [3,0,0], [3,0,0], [0,\"width\",0]]\n")),
      ElementsAre(AllOf(HasSubstr("points 1 and 2 are equal"),
                        HasSubstr("case.toml:11"))));
  EXPECT_THAT(
      problems_of(disk("[curves.rim]\nkind = \"spline\"\npoints = [[0,0,0], "
                       "[3,0,\"sqrt(1 - width)\"], [3,2,0]]\n")),
      testing::Contains(AllOf(HasSubstr("case.toml:13"),
                              HasSubstr("curves.rim.points[1][z]"))));
  EXPECT_THAT(
      problems_of(disk("[curves.rim]\nkind = \"polygon\"\npoints = [[0,0,0], "
                       "{ through = [1, 1, 0] }, [3,2,0], [3,0,0]]\n")),
      ElementsAre(AllOf(HasSubstr("case.toml:13"),
                        HasSubstr("only a polyline knows"))));
  EXPECT_THAT(
      problems_of(disk("[curves.rim]\nkind = \"polyline\"\npoints = "
                       "[{ through = [1, 1, 0] }, [3,2,0], [3,0,0]]\n")),
      ElementsAre(HasSubstr("put a corner before it")));
  EXPECT_THAT(
      problems_of(disk("[curves.rim]\nkind = \"copy\"\nof = \"sed\"\n"
                       "[curves.seed]\nkind = \"circle\"\n"
                       "center = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\n")),
      ElementsAre(HasSubstr("there is no curve 'sed'")));
  EXPECT_THAT(
      problems_of(disk("[curves.rim]\nkind = \"copy\"\nof = \"seed\"\n"
                       "[curves.seed]\nkind = \"circle\"\n"
                       "center = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\n")),
      ElementsAre(HasSubstr("[curves.seed] stands below; move it above")));
  const std::string seed =
      "[curves.seed]\nkind = \"circle\"\ncenter = [0, 0, 0]\n"
      "normal = [0, 0, 1]\nradius = \"width\"\n";
  EXPECT_THAT(
      problems_of(disk(seed + "[curves.rim]\nkind = \"copy\"\nof = "
                              "\"seed\"\noffset = \"-width\"\n")),
      testing::Each(AllOf(HasSubstr("case.toml:16"), HasSubstr("offset by -"),
                          HasSubstr("where width = "))));
  EXPECT_THAT(problems_of(disk(seed + "[curves.rim]\nkind = \"copy\"\nof = "
                                      "\"seed\"\nrotate = 1\n")),
              ElementsAre(HasSubstr("has rotate and no axis")));
}

TEST(CaseCurves, ThatMeetAreToldByName) {
  const std::string text = disk(
      "[curves.rim]\nkind = \"circle\"\ncenter = [0, 0, 0]\n"
      "normal = [0, 0, 1]\nradius = 2\n[curves.other]\nkind = \"copy\"\n"
      "of = \"rim\"\nmove = [\"4 * width / width\", 0, 0]\n"
      "[films.second]\nkind = \"disk\"\ncurves = [\"other\"]\n");
  EXPECT_THAT(problems_of(text),
              testing::Each(AllOf(HasSubstr("case.toml:16: curves 'rim' and "
                                            "'other' meet near (2, "),
                                  HasSubstr("name the same curve"))));
  EXPECT_FALSE(problems_of(text).empty());
}

// Named is the curve that moves, not the one that stands, and what moves it.
TEST(CaseCurves, ThatMeetAtTheEndOfABoundAreToldWithIt) {
  const std::string text = disk(
      "[curves.rim]\nkind = \"circle\"\ncenter = [\"2 * width\", 0, 0]\n"
      "normal = [0, 0, 1]\nradius = 2\n[curves.other]\nkind = \"circle\"\n"
      "center = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 2\n"
      "[films.second]\nkind = \"disk\"\ncurves = [\"other\"]\n");
  EXPECT_THAT(problems_of(text),
              testing::Each(AllOf(
                  HasSubstr("curves 'rim' and 'other' meet near (2, "),
                  HasSubstr("where width = 2"),
                  HasSubstr("(with 'width' at the end of its bounds, 2)"))));
  EXPECT_FALSE(problems_of(text).empty());
}

// Rings of radius 1 at z = +-0.5: area 5.99179697580228.
TEST(CaseCurves, ALoftBetweenACurveAndItsCopyIsACatenoid) {
  constexpr double kExact = 5.99179697580228;
  constexpr double kFacets = 2e-3;  // of flat facets of edge 0.05
  for (const char* normal : {"0, 0, 1", "0, 0, -1"}) {  // either way round
    const case_data::Case input = case_of(std::string(R"(title = "Catenoid"
units = "m-N-Pa"
[curves.low]
kind = "circle"
center = [0, 0, -0.5]
normal = [)") + normal + R"(]
radius = 1
[curves.high]
kind = "circle"
center = [0, 0, 0.5]
normal = [0, 0, 1]
radius = 1
[films.skin]
kind = "loft"
curves = ["low", "high"]
[walls.web]
films = ["skin"]
thickness = 0.01
[resolution]
fea = 0.1
)");
    const case_data::EvaluatedCase inputs =
        case_data::evaluate(input, case_data::initial_design(input));
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        inputs.film_system, {.edge = 0.1, .refinements = 1});
    ASSERT_FALSE(model.reference().failure);
    EXPECT_NEAR(model.reference().report.area / kExact, 1.0, kFacets);
  }
}

// Edges along the rim are as long as its pieces, those far from it as long as
// resolution.fea; pieces longer than that change nothing.
TEST(CaseCurves, AreCutIntoPieces) {
  const auto edges = [](const std::string& pieces) {
    const case_data::Case input =
        case_of(disk("[curves.rim]\nkind = \"circle\"\ncenter = [0, 0, 0]\n"
                     "normal = [0, 0, 1]\nradius = 8\n" +
                     pieces));
    const films::FilmSystem system =
        case_data::evaluate(input, case_data::initial_design(input))
            .film_system;
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = 1.0, .refinements = 0});
    EXPECT_FALSE(model.reference().failure);
    const SurfaceMesh mesh = model.fine_mesh(model.reference().points);
    std::array<double, 2> longest = {0.0, 0.0};  // at the rim, in the middle
    for (const Triangle& t : mesh.facets) {
      for (int k = 0; k < 3; ++k) {
        const Vec3& a = mesh.points[t[k]];
        const Vec3& b = mesh.points[t[(k + 1) % 3]];
        const double far = std::min(a.norm(), b.norm());
        if (far > 7.99) {
          longest[0] = std::max(longest[0], (a - b).norm());
        } else if (std::max(a.norm(), b.norm()) < 4.0) {
          longest[1] = std::max(longest[1], (a - b).norm());
        }
      }
    }
    return longest;
  };
  const std::array<double, 2> plain = edges("");
  const std::array<double, 2> fine = edges("pieces = 0.25\n");
  EXPECT_NEAR(plain[0], 1.0, 0.1);
  EXPECT_NEAR(fine[0], 0.25, 0.025);
  EXPECT_GT(fine[1], 0.6);
  EXPECT_EQ(edges("pieces = 3\n"), plain);
}

TEST(CaseCurves, PiecesAreLengthsAboveZero) {
  const auto asked = [](const std::string& pieces) {
    return problems_of(
        disk("[curves.rim]\nkind = \"circle\"\ncenter = [0, 0, 0]\n"
             "normal = [0, 0, 1]\nradius = 8\npieces = " +
             pieces + "\n"));
  };
  EXPECT_THAT(asked("-1"),
              ElementsAre(HasSubstr("case.toml:16: curves.rim.pieces is -1; "
                                    "it must be above 0")));
  EXPECT_THAT(asked("\"2 N\""), ElementsAre(HasSubstr("is no length")));
}

}  // namespace
}  // namespace meniscus::case_curves_test
