// Boundary curves from the edges of STEP files.
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cad/step/step_writer.h"
#include "core/atomic_file.h"
#include "evolve/curves/curve_contact.h"
#include "evolve/frozen/film_model.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/step_parts/export_step.h"
#include "pipeline/store/stored_case.h"
#include "tests/support/temp_folder.h"

namespace meniscus::case_curve_files_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

/// A strut between two curves [mm]; `curves` defines foot and head, from line
/// 4 on.
std::string strut(const std::string& curves, const std::string& units) {
  return "title = \"Strut\"\nunits = \"" + units + "\"\n[parameters]\n" +
         "unit = " + (units == "m-N-Pa" ? "0.001" : "1.0") + "\n" + curves +
         R"([films.skin]
kind = "loft"
curves = ["foot", "head"]
[solids.bottom]
kind = "cap"
curve = "foot"
[solids.top]
kind = "cap"
curve = "head"
[bodies.part]
enclosed_by = ["skin", "bottom", "top"]
volume = "1.6e4 * unit^3"
material = "steel"
[materials.steel]
youngs_modulus = 1
poisson_ratio = 0.3
density = 1
[resolution]
fea = ")" +
         "4 * unit" + R"("
[load_cases.pull]
supports = [{ on = "bottom", fix = "xyz" }]
loads = [{ on = "top", force = [0, 0, 1] }]
[responses.work]
kind = "compliance"
)";
}

const char* const kOvals = R"([curves.foot]
kind = "ellipse"
center = [1, 2, 0]
normal = [0, 0, -1]
axis = [1, 0, 0]
radius_1 = 12
radius_2 = 10
[curves.head]
kind = "circle"
center = [4, 0, 30]
normal = [0.1, 0, 1]
radius = 9
)";

const char* const kRoundedBox = R"([curves.foot]
kind = "rectangle"
center = [1, 2, 0]
normal = [0, 0, -1]
axis = [1, 0, 0]
width = 24
height = 20
corner_radius = 5
[curves.head]
kind = "circle"
center = [4, 0, 30]
normal = [0.1, 0, 1]
radius = 9
)";

const char* const kRims = R"([curves.foot]
kind = "file"
file = "part.step"
face = "bottom"
[curves.head]
kind = "file"
file = "part.step"
face = "top"
)";

class CurvesOfStep : public testing::Test {
 protected:
  std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  reader::CaseReading read(const std::string& text) const {
    return reader::read_case_text(text, path("case.toml"));
  }
  case_data::Case good(const std::string& text) const {
    const reader::CaseReading reading = read(text);
    EXPECT_THAT(reading.problems, IsEmpty());
    return reading.input ? *reading.input : case_data::Case{};
  }
  /// The strut between its own curves, written to part.step.
  case_data::Case write_part(const std::string& curves = kRoundedBox) const {
    const case_data::Case own = good(strut(curves, "mm-N-MPa"));
    step_parts::export_step(
        path("part.step"),
        case_data::evaluate(own, case_data::initial_design(own)).film_system,
        {.title = "strut", .unit = "mm", .edge = 4.0});
    return own;
  }
  static settle::FilmState film_of(const case_data::Case& input) {
    const case_data::EvaluatedCase inputs =
        case_data::evaluate(input, case_data::initial_design(input));
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        inputs.film_system, {.edge = inputs.fea_edge});
    EXPECT_FALSE(model.reference().failure);
    return model.reference();
  }
  TempFolder folder_;
};

TEST_F(CurvesOfStep, GiveTheFilmThatTheFileWasWrittenFrom) {
  constexpr double kSame = 1e-6;
  const case_data::Case own = write_part(kOvals);
  const case_data::Case again = good(strut(kRims, "mm-N-MPa"));
  EXPECT_THAT(
      again.remarks,
      ElementsAre(AllOf(HasSubstr("case.toml:7: curves.foot: "),
                        HasSubstr("an ellipse of radii 12 and 10 mm, exact")),
                  HasSubstr("curves.head: a circle of radius 9 mm, exact")));
  // One model, so that rounding in the file cannot choose other triangles.
  const case_data::EvaluatedCase a =
      case_data::evaluate(own, case_data::initial_design(own));
  const case_data::EvaluatedCase b =
      case_data::evaluate(again, case_data::initial_design(again));
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(a.film_system, {.edge = a.fea_edge});
  const settle::FilmState& before = model.reference();
  ASSERT_FALSE(before.failure);
  const settle::FilmState after = model.settle(b.film_system);
  ASSERT_FALSE(after.failure);
  EXPECT_NEAR(after.report.area / before.report.area, 1.0, kSame);
  EXPECT_NEAR(
      after.report.bodies[0].pressure / before.report.bodies[0].pressure, 1.0,
      kSame);
  double most = 0.0;
  for (std::size_t v = 0; v < before.points.size(); ++v) {
    most = std::max(most, (after.points[v] - before.points[v]).norm());
  }
  EXPECT_LT(most, kSame * 30.0);  // of the length [mm]
}

TEST_F(CurvesOfStep, OfLinesAndArcsAreExact) {
  // Corners are counted from another one: another triangulation.
  constexpr double kSameFilm = 1e-4;
  const case_data::Case own = write_part();
  const case_data::Case again = good(strut(kRims, "mm-N-MPa"));
  ASSERT_EQ(again.curves.size(), 2U);
  EXPECT_EQ(again.curves[0].kind, case_data::CurveKind::Polyline);
  EXPECT_EQ(again.curves[0].points.size(), 12U);  // cut edges are joined
  EXPECT_EQ(again.curves[1].kind, case_data::CurveKind::Circle);
  EXPECT_THAT(again.remarks,
              Contains(HasSubstr("4 straight sides and 4 arcs, exact")));
  const case_data::EvaluatedCase a =
      case_data::evaluate(own, case_data::initial_design(own));
  const case_data::EvaluatedCase b =
      case_data::evaluate(again, case_data::initial_design(again));
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_TRUE(curves::lie_on_each_other(a.film_system.curves[c].shape,
                                          b.film_system.curves[c].shape, 1e-9));
  }
  EXPECT_NEAR(film_of(again).report.area / film_of(own).report.area, 1.0,
              kSameFilm);
}

TEST_F(CurvesOfStep, AreConvertedToTheUnitsOfTheCase) {
  write_part();
  // The file is in mm whatever the case's units are.
  const case_data::Case metre = good(strut(kRims, "m-N-Pa"));
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(metre, case_data::initial_design(metre));
  EXPECT_NEAR(curves::length_of(inputs.film_system.curves[1].shape),
              2.0 * kPi * 9e-3, 1e-12);
}

TEST_F(CurvesOfStep, BelongToTheCase) {
  write_part();
  const case_data::Case first = good(strut(kRims, "mm-N-MPa"));
  const std::string stored = store::stored_case(first);
  std::filesystem::remove(path("part.step"));
  const case_data::Case again = store::restore_case({.case_text = stored});
  EXPECT_EQ(again.hash, first.hash);
  EXPECT_EQ(again.remarks, first.remarks);
  const case_data::EvaluatedCase a =
      case_data::evaluate(first, case_data::initial_design(first));
  const case_data::EvaluatedCase b =
      case_data::evaluate(again, case_data::initial_design(again));
  for (std::size_t c = 0; c < 2; ++c) {
    for (const double t : {0.0, 0.3, 0.9}) {
      EXPECT_EQ(curves::point_at(a.film_system.curves[c].shape, t),
                curves::point_at(b.film_system.curves[c].shape, t));
    }
  }
  EXPECT_THAT(read(strut(kRims, "mm-N-MPa")).problems,
              Contains(AllOf(HasSubstr("case.toml:7: curves.foot.file"),
                             HasSubstr("there is no file"))));
}

TEST_F(CurvesOfStep, ThatAreWrongAreRefusedByLine) {
  write_part();
  const std::string rims = kRims;
  const std::string head = rims.substr(rims.find("[curves.head]"));
  const auto problems = [&](const std::string& keys) {
    return read(strut("[curves.foot]\nkind = \"file\"\nfile = "
                      "\"part.step\"\n" +
                          keys + head,
                      "mm-N-MPa"))
        .problems;
  };
  EXPECT_THAT(problems("face = \"botom\"\n"),
              ElementsAre(AllOf(HasSubstr("case.toml:8: curves.foot.face"),
                                HasSubstr("did you mean 'bottom'?"))));
  EXPECT_THAT(problems("edge = 900\n"),
              ElementsAre(AllOf(HasSubstr("case.toml:8: curves.foot.edge"),
                                HasSubstr("has no edge '900'; it has"),
                                // None closes by itself; longest first.
                                ContainsRegex("number: 17: curve of length 32"
                                              ".* circle of length 14"))));
  EXPECT_THAT(problems(""), ElementsAre(HasSubstr("neither edge nor face")));
  EXPECT_THAT(problems("edge = 1\nface = \"bottom\"\n"),
              ElementsAre(HasSubstr("both edge and face")));
  EXPECT_THAT(problems("face = \"bottom\"\nas = \"polygon\"\n"),
              ElementsAre(AllOf(HasSubstr("case.toml:9"),
                                HasSubstr("is of csv files"))));
}

/// Edges of a box, of which the four about one face close.
TEST_F(CurvesOfStep, OfSeveralEdgesMustClose) {
  solid::Brep box;
  for (int k = 0; k < 8; ++k) {
    box.vertices.emplace_back((k & 1) * 3.0, (k >> 1 & 1) * 2.0,
                              (k >> 2) * 1.0);
  }
  const std::vector<std::array<int, 4>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6},
                                                 {0, 1, 5, 4}, {2, 6, 7, 3},
                                                 {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& corners : faces) {
    const Vec3 a = box.vertices[corners[0]];
    const Vec3 u = box.vertices[corners[1]] - a;
    const Vec3 v = box.vertices[corners[3]] - a;
    solid::BrepFace face{"side_" + std::to_string(box.faces.size()),
                         solid::PlaneSurface{a, Vec3(u.cross(v)).normalized()},
                         {{}}};
    for (int k = 0; k < 4; ++k) {
      const int from = std::min(corners[k], corners[(k + 1) % 4]);
      const int to = std::max(corners[k], corners[(k + 1) % 4]);
      int found = -1;
      for (std::size_t e = 0; e < box.edges.size(); ++e) {
        if (box.edges[e].from == from && box.edges[e].to == to) {
          found = static_cast<int>(e);
        }
      }
      if (found < 0) {
        const Vec3 way = box.vertices[to] - box.vertices[from];
        found = static_cast<int>(box.edges.size());
        box.edges.push_back(
            {from, to,
             solid::StraightLine{box.vertices[from], way.normalized()}, 0.0,
             way.norm()});
      }
      face.loops[0].push_back({found, from == corners[k]});
    }
    box.faces.push_back(face);
  }
  step::write_step(path("part.step"), box);
  const auto text = [&](const std::string& edge) {
    return "title = \"t\"\nunits = \"mm-N-MPa\"\n[curves.rim]\nkind = "
           "\"file\"\n"
           "file = \"part.step\"\nedge = " +
           edge +
           "\n[films.skin]\nkind = \"disk\"\ncurves = [\"rim\"]\n[walls.w]\n"
           "films = [\"skin\"]\nthickness = 0.1\n[resolution]\nfea = 0.5\n";
  };
  const case_data::Case four = good(text("[3, 1, 4, 2]"));
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(four, case_data::initial_design(four));
  EXPECT_NEAR(curves::length_of(inputs.film_system.curves[0].shape), 10.0,
              1e-12);
  EXPECT_THAT(read(text("[1, 2, 3]")).problems,
              ElementsAre(AllOf(HasSubstr("case.toml:6: curves.rim.edge"),
                                HasSubstr("the edges do not close"))));
  EXPECT_THAT(read(text("[1, 2, 2]")).problems,
              ElementsAre(HasSubstr("edge '2' is named twice")));
  EXPECT_THAT(
      read(text("\"rim\"")).problems,
      ElementsAre(AllOf(HasSubstr("has no edge 'rim'; it has 12"),
                        HasSubstr("line of length 2 about (0, 1, 0)"))));
}

}  // namespace
}  // namespace meniscus::case_curve_files_test
