// Films that start from facets in the case or in a file.
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "evolve/frozen/film_model.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/store/stored_case.h"
#include "tests/support/temp_folder.h"

namespace meniscus::case_facets_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kSphere = 4.83597586204941;    // area of volume 1
constexpr double kCatenoid = 5.99179697580228;  // rings of radius 1, 1 apart

const char* const kEnd = R"case([materials.steel]
youngs_modulus = 1
poisson_ratio = 0.3
density = 1
[load_cases.push]
supports = [{ on = "skin", normal_stiffness = 1 }]
loads = [{ on = "skin", pressure = "x" }]
[responses.work]
kind = "compliance"
)case";

/// A free body about the unit cube; `resolution`: keys of that table.
std::string cube(const std::string& resolution) {
  return std::string(R"case(title = "Cube to sphere"
units = "m-N-Pa"
[parameters]
side = 1.0
[films.skin]
kind = "facets"
vertices = [
  [0, 0, 0], ["side", 0, 0], ["side", "side", 0], [0, "side", 0],
  [0, 0, "side"], ["side", 0, "side"], ["side", "side", "side"], [0, "side", 1],
]
facets = [
  [0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6],
  [3, 0, 4, 7],
]
[bodies.part]
enclosed_by = ["skin"]
volume = "side^3"
material = "steel"
[resolution]
)case") + resolution +
         kEnd;
}

case_data::Case good(const std::string& text,
                     const std::string& path = "case.toml") {
  const reader::CaseReading reading = reader::read_case_text(text, path);
  EXPECT_THAT(reading.problems, IsEmpty());
  return reading.input ? *reading.input : case_data::Case{};
}

frozen::FilmModel model_of(const case_data::Case& input) {
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  return frozen::FilmModel::freeze(
      inputs.film_system,
      {.edge = inputs.fea_edge, .refinements = input.resolution.refinements});
}

TEST(CaseFacets, ACubeBecomesASphere) {
  // The paper's 8 x 8 x 8: facets are kept and halved three times.
  const case_data::Case input =
      good(cube("fea = 0.14\nfilm = 0.14\nkeep_facets = true\n"));
  const frozen::FilmModel model = model_of(input);
  const settle::FilmState& film = model.reference();
  ASSERT_FALSE(film.failure) << film.failure->message;
  EXPECT_EQ(film.report.facets, 768);
  constexpr double kCoarse = 0.02;  // of 768 flat facets about a sphere
  EXPECT_NEAR(film.report.area / kSphere, 1.0, kCoarse);
  EXPECT_GT(film.report.area, kSphere);  // facets of that volume have more
  EXPECT_NEAR(film.report.bodies[0].volume, 1.0, 1e-9);
  EXPECT_EQ(film.report.index, 0);
}

TEST(CaseFacets, TheErrorFallsFourfoldWithEachRefinement) {
  std::vector<double> errors;
  for (const char* edge : {"0.28", "0.14", "0.07"}) {
    const frozen::FilmModel model =
        model_of(good(cube(std::string("keep_facets = true\nfea = ") + edge +
                           "\nfilm = " + edge + "\n")));
    ASSERT_FALSE(model.reference().failure);
    errors.push_back(model.reference().report.area / kSphere - 1.0);
  }
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.6);
  EXPECT_NEAR(errors[1] / errors[2], 4.0, 0.4);
}

TEST(CaseFacets, AFreeBodyIsRemeshedToItsEdgeAndFollowsItsVolume) {
  const case_data::Case input = good(cube("fea = 0.15\n"));
  const frozen::FilmModel model = model_of(input);
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  EXPECT_NEAR(model.reference().report.area / kSphere, 1.0, 0.01);
  // Another design of the frozen model: six motions cost nothing.
  case_data::EvaluatedCase more =
      case_data::evaluate(input, case_data::initial_design(input));
  more.film_system.bodies[0].volume = 1.3;
  const settle::FilmState larger = model.settle(more.film_system);
  ASSERT_FALSE(larger.failure) << larger.failure->message;
  // Vertices move along the start's normals, which are not quite radial.
  constexpr double kNotRadial = 1e-5;
  EXPECT_NEAR(larger.report.area / model.reference().report.area,
              std::pow(1.3, 2.0 / 3.0), kNotRadial);
  // The pressure is the derivative of the energy by the volume.
  constexpr double kStep = 1e-3;
  more.film_system.bodies[0].volume = 1.3 + kStep;
  const double up = model.settle(more.film_system).report.energy;
  more.film_system.bodies[0].volume = 1.3 - kStep;
  const double down = model.settle(more.film_system).report.energy;
  EXPECT_NEAR((up - down) / (2.0 * kStep), larger.report.bodies[0].pressure,
              1e-5);
}

/// Rings of radius 1 at z = +-0.5, and a band between them whose rims have
/// `low` and `high` vertices.
std::string rings(const std::string& film) {
  return R"case(title = "Catenoid"
units = "m-N-Pa"
[curves.low]
kind = "circle"
center = [0, 0, -0.5]
normal = [0, 0, 1]
radius = 1
[curves.high]
kind = "circle"
center = [0, 0, 0.5]
normal = [0, 0, 1]
radius = 1
)case" + film +
         R"case([walls.web]
films = ["skin"]
thickness = 0.01
[resolution]
fea = 0.12
)case";
}

std::string band(const std::string& more) {
  return rings(R"case([films.skin]
kind = "facets"
curves = ["low", "high"]
vertices = [
  { at = ["cos(i * pi / 3)", "sin(i * pi / 3)", -0.5], repeat = 6 },
  { at = ["cos(i * pi / 3 + 0.4)", "sin(i * pi / 3 + 0.4)", 0.5], repeat = 6 },
]
facets = [
  [0, 1, 6], [1, 7, 6], [1, 2, 7], [2, 8, 7], [2, 3, 8], [3, 9, 8],
  [3, 4, 9], [4, 10, 9], [4, 5, 10], [5, 11, 10], [5, 0, 11], [0, 6, 11],
]
)case" + more);
}

TEST(CaseFacets, RimsAreHeldByTheirCurves) {
  const frozen::FilmModel model = model_of(good(band("")));
  ASSERT_FALSE(model.reference().failure);
  EXPECT_NEAR(model.reference().report.area / kCatenoid, 1.0, 1e-3);
  EXPECT_GT(model.rim("low").size(), 50U);  // cut to the edge length
  EXPECT_GT(model.rim("high").size(), 50U);
}

TEST(CaseFacets, JoinOtherFilmsOnTheirCurves) {
  // A flat disk across the lower ring: three vertices of its own on it.
  const case_data::Case input = good(band(R"case([films.floor]
kind = "facets"
curves = ["low"]
vertices = [[1, 0, -0.5], ["cos(2)", "sin(2)", -0.5], ["cos(4)", "sin(4)", -0.5]]
facets = [[0, 1, 2]]
[films.lid]
kind = "disk"
curves = ["high"]
)case"));
  const frozen::FilmModel model = model_of(input);
  ASSERT_FALSE(model.reference().failure);
  EXPECT_NEAR(model.reference().report.area, kCatenoid + 2.0 * std::numbers::pi,
              0.02);
}

TEST(CaseFacets, ComeFromFilesThatBelongToTheCase) {
  const TempFolder folder;
  const std::string path = (folder / "case.toml").string();
  std::string obj = "g side\n";
  for (int k = 0; k < 12; ++k) {
    const double angle = k * std::numbers::pi / 6.0;
    for (const double z : {-500.0, 500.0}) {
      obj += "v " + std::to_string(1000.0 * std::cos(angle)) + " " +
             std::to_string(1000.0 * std::sin(angle)) + " " +
             std::to_string(z) + "\n";
    }
  }
  for (int k = 0; k < 12; ++k) {
    const auto id = [](int n) { return std::to_string(n % 24 + 1); };
    obj += "f " + id(2 * k) + " " + id(2 * k + 2) + " " + id(2 * k + 3) + " " +
           id(2 * k + 1) + "\n";
  }
  write_file(folder / "band.obj", obj);
  const std::string text = rings(
      "[films.skin]\nkind = \"file\"\nfile = \"band.obj\"\nsurface = \"side\"\n"
      "scale = 0.001\ncurves = [\"low\", \"high\"]\n");
  write_file(path, text);
  const case_data::Case input = good(text, path);
  EXPECT_NEAR(model_of(input).reference().report.area / kCatenoid, 1.0, 1e-3);
  const std::string stored = store::stored_case(input);
  std::filesystem::remove(folder / "band.obj");
  EXPECT_EQ(store::restore_case({.case_text = stored}).hash, input.hash);
  EXPECT_THAT(reader::read_case_file(path).problems,
              Contains(AllOf(HasSubstr("films.skin: there is no file"),
                             HasSubstr("band.obj"))));
}

/// A band of twelve flat sides between two rings of radius 1, cut in triangles.
std::vector<std::array<Vec3, 3>> twelve_sides() {
  const auto corner = [](int k, double z) {
    const double angle = k * std::numbers::pi / 6.0;
    return Vec3(std::cos(angle), std::sin(angle), z);
  };
  std::vector<std::array<Vec3, 3>> facets;
  for (int k = 0; k < 12; ++k) {
    facets.push_back(
        {corner(k, -0.5), corner(k + 1, -0.5), corner(k + 1, 0.5)});
    facets.push_back({corner(k, -0.5), corner(k + 1, 0.5), corner(k, 0.5)});
  }
  return facets;
}

std::string as_stl(const std::vector<std::array<Vec3, 3>>& facets) {
  std::string text = "solid side\n";
  for (const auto& corners : facets) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : corners) {
      text += fmt::format("vertex {} {} {}\n", x.x(), x.y(), x.z());
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid side\n";
}

/// A Surface Evolver datafile: of each side a quadrilateral.
std::string as_datafile() {
  std::string vertices = "vertices\n";
  std::string edges = "edges\n";
  std::string faces = "faces\n";
  for (int k = 0; k < 12; ++k) {
    const double angle = k * std::numbers::pi / 6.0;
    const int next = (k + 1) % 12;
    for (const int top : {0, 1}) {
      vertices += fmt::format("{} {} {} {}\n", 12 * top + k + 1,
                              std::cos(angle), std::sin(angle), top - 0.5);
      edges += fmt::format("{} {} {}\n", 12 * top + k + 1, 12 * top + k + 1,
                           12 * top + next + 1);
    }
    edges += fmt::format("{} {} {}\n", 25 + k, k + 1, k + 13);
    faces += fmt::format("{} {} {} -{} -{}\n", k + 1, k + 1, 25 + next, 13 + k,
                         25 + k);
  }
  return vertices + edges + faces;
}

TEST(CaseFacets, StartFromStlAndDatafilesAsFromTheirOwn) {
  const TempFolder folder;
  const std::string path = (folder / "case.toml").string();
  write_file(folder / "band.stl", as_stl(twelve_sides()));
  write_file(folder / "band.fe", as_datafile());
  for (const char* file : {"band.stl", "band.fe"}) {
    const case_data::Case input =
        good(rings(std::string("[films.skin]\nkind = \"file\"\nfile = \"") +
                   file + "\"\ncurves = [\"low\", \"high\"]\n"),
             path);
    const frozen::FilmModel model = model_of(input);
    ASSERT_FALSE(model.reference().failure) << file;
    EXPECT_NEAR(model.reference().report.area / kCatenoid, 1.0, 1e-3) << file;
    EXPECT_EQ(model.reference().report.index, 0) << file;
  }
}

TEST(CaseFacets, OfSolidsFromFilesCloseABodyAndStay) {
  // A cylinder's film between two rings whose ends are a plane cap and, from a
  // file, a pyramid of twelve sides that stands 0.3 out of the ring.
  const TempFolder folder;
  const std::string path = (folder / "case.toml").string();
  constexpr double kOut = 0.3;
  std::string obj;
  for (int k = 0; k < 12; ++k) {
    const double angle = k * std::numbers::pi / 6.0;
    obj += fmt::format("v {} {} 0.5\n", std::cos(angle), std::sin(angle));
  }
  obj += fmt::format("v 0 0 {}\n", 0.5 + kOut);
  for (int k = 0; k < 12; ++k) {
    obj += fmt::format("f {} {} 13\n", k + 1, (k + 1) % 12 + 1);
  }
  write_file(folder / "end.obj", obj);
  std::string text = rings(R"case([films.skin]
kind = "loft"
curves = ["low", "high"]
[solids.foot]
kind = "cap"
curve = "low"
[solids.end]
kind = "file"
file = "end.obj"
curves = ["high"]
[bodies.part]
enclosed_by = ["skin", "foot", "end"]
volume = 3.4
material = "steel"
)case");
  text.erase(text.find("[walls.web]"),
             text.find("[resolution]") - text.find("[walls.web]"));
  const case_data::Case input = good(text + kEnd, path);
  const frozen::FilmModel model = model_of(input);
  const settle::FilmState& film = model.reference();
  ASSERT_FALSE(film.failure) << film.failure->message;
  EXPECT_NEAR(film.report.bodies[0].volume, 3.4, 1e-9);
  // The end's peak is where the file has it, and the rest of it nowhere higher.
  double highest = 0.0;
  for (const Vec3& x : film.points) {
    highest = std::max(highest, x.z());
  }
  EXPECT_NEAR(highest, 0.5 + kOut, 1e-9);
}

std::vector<std::string> problems_of(std::string text, const std::string& from,
                                     const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return reader::read_case_text(text, "case.toml").problems;
}

TEST(CaseFacets, ThatAreWrongAreRefusedByLine) {
  const std::string closed = cube("fea = 0.2\n");
  EXPECT_THAT(
      problems_of(closed, ",\n  [3, 0, 4, 7],", ","),
      ElementsAre(AllOf(HasSubstr("case.toml:5: film 'skin' is open at"),
                        HasSubstr("names no curve"))));
  EXPECT_THAT(problems_of(closed, "[3, 0, 4, 7]", "[3, 0, 4, 8]"),
              Contains(AllOf(HasSubstr("case.toml:13: films.skin.facets[5]"),
                             HasSubstr("from 0 to 7"))));
  EXPECT_THAT(problems_of(closed, "[3, 0, 4, 7]", "[3, 0, 3, 7]"),
              ElementsAre(HasSubstr("has no area")));
}

TEST(CaseFacets, WhoseRimsFindNoCurveSayWhere) {
  EXPECT_THAT(
      problems_of(band(""), "curves = [\"low\", \"high\"]",
                  "curves = [\"low\"]"),
      ElementsAre(AllOf(HasSubstr("case.toml:13: film 'skin': its rim at"),
                        HasSubstr("the nearest, 'low', is"),
                        HasSubstr("name the curve there"))));
  EXPECT_THAT(
      problems_of(band(""), "radius = 1\n[curves.high]",
                  "radius = 1.2\n[curves.high]"),
      ElementsAre(AllOf(HasSubstr("lies on none of its curves"),
                        HasSubstr("is 0.2 away, and 0.03 is allowed"))));
  // As far as it is told to be.
  EXPECT_THAT(problems_of(band(""), "kind = \"facets\"",
                          "kind = \"facets\"\nwithin = 0.25"),
              IsEmpty());
}

}  // namespace
}  // namespace meniscus::case_facets_test
