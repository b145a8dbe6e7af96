// Tension of x, y, z, walls and field energies from case file to film.
#include <array>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/forward/walls.h"
#include "tests/support/case_text.h"
#include "tests/support/temp_folder.h"

namespace meniscus::case_films_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

case_data::EvaluatedCase numbers_of(const std::string& text) {
  const reader::CaseReading reading = reader::read_case_text(text, "case.toml");
  EXPECT_THAT(reading.problems, IsEmpty());
  EXPECT_THAT(reading.warnings, IsEmpty());
  return case_data::evaluate(*reading.input,
                             case_data::initial_design(*reading.input));
}

std::string with(const std::string& more) {
  return changed(strut(), "[resolution]", more + "[resolution]");
}

double at(const PlaceField& field, double x, double y, double z) {
  return value_at(field, field.own(), {x, y, z});
}

TEST(CaseTension, OfPlaceTakesTheCasesNumbers) {
  const auto tension = [](const std::string& text) {
    return numbers_of(changed(strut(), "curves = [\"base\", \"head\"]\n",
                              "curves = [\"base\", \"head\"]\ntension = " +
                                  text + "\n"))
        .film_system.films[0];
  };
  const films::FilmSpec film = tension(
      "\"load/1e3 + 2.5e-1*exp(-z/length) + min(e, 1.e+1)*if(x > 30, 1, 0)\"");
  ASSERT_TRUE(film.tension_field);
  EXPECT_DOUBLE_EQ(at(*film.tension_field, 0, 0, 30),
                   1.0 + 0.25 * std::exp(-0.5));
  EXPECT_DOUBLE_EQ(at(*film.tension_field, 31, 0, 0), 1.25 + std::exp(1.0));
  EXPECT_FALSE(film.tension_field->has_numbers());  // load and length stay
  const films::FilmSpec moves = tension("\"load/1e3 + foot*exp(-z/length)\"");
  EXPECT_THAT(moves.tension_field->names, ElementsAre("foot"));
  EXPECT_THAT(moves.tension_field->numbers, ElementsAre(25.0));
  EXPECT_DOUBLE_EQ(at(*moves.tension_field, 1, 2, 30),
                   1.0 + 25.0 * std::exp(-0.5));
  EXPECT_EQ(tension("\"foot / 10\"").tension, 2.5);
  EXPECT_FALSE(tension("\"foot / 10\"").tension_field);
  EXPECT_DOUBLE_EQ(tension("\"2 N/m\"").tension, 2e-3);
}

TEST(CaseFields, BecomeSpecs) {
  const films::FilmSystem system =
      numbers_of(with("[fields.pole]\nkind = \"segment\"\nfrom = [0, 0, 0]\n"
                      "to = [0, 0, \"length\"]\nstrength = -0.5\n"
                      "core = \"1 cm\"\nfilms = [\"skin\"]\n"
                      "[fields.heavy]\nkind = \"plane\"\nat = [0, 0, 1]\n"
                      "normal = [0, 0, 1]\nstrength = \"2 MPa\"\npower = 3\n"
                      "core = 5\nbody = \"part\"\n"
                      "[fields.gas]\nkind = \"pressure\"\nbody = \"part\"\n"
                      "pressure = \"load*1e-6*(length - z)\"\n"))
          .film_system;
  ASSERT_EQ(system.fields.size(), 2U);
  const films::FieldSpec& pole = system.fields[0];
  EXPECT_EQ(std::get<films::SegmentPole>(pole.shape).to, Vec3(0, 0, 60));
  EXPECT_EQ(pole.strength, -0.5);
  EXPECT_EQ(pole.power, 2.0);
  EXPECT_DOUBLE_EQ(pole.core, 10.0);
  EXPECT_THAT(std::get<films::PerArea>(pole.per).surfaces, ElementsAre("skin"));
  EXPECT_EQ(system.fields[1].power, 3.0);
  EXPECT_EQ(std::get<films::PerVolume>(system.fields[1].per).body, "part");
  ASSERT_EQ(system.pressures.size(), 1U);
  EXPECT_DOUBLE_EQ(at(system.pressures[0].pressure, 0, 0, 20), 0.04);
}

TEST(CaseFields, ActOnTheFilm) {
  const auto model = [](const std::string& text) {
    return frozen::FilmModel::freeze(numbers_of(text).film_system,
                                     {.edge = 10.0});
  };
  const frozen::FilmModel plain = model(strut());
  const frozen::FilmModel pushed =
      model(with("[fields.push]\nkind = \"plane\"\nat = [0, 0, 30]\n"
                 "normal = [0, 0, 1]\nstrength = -0.3\ncore = 6\n"
                 "films = [\"skin\"]\n"));
  ASSERT_FALSE(pushed.reference().failure);
  EXPECT_GT(pushed.reference().report.energy,
            1.02 * plain.reference().report.energy);
}

TEST(CaseWalls, NeedNoBodies) {
  const case_data::EvaluatedCase inputs =
      numbers_of(tube("films = [\"skin\"]\n"
                      "thickness = \"1 + length*z/1e3\"\n"));
  ASSERT_EQ(inputs.walls.size(), 1U);
  EXPECT_EQ(inputs.walls[0].side, walls::WallSide::Both);
  EXPECT_DOUBLE_EQ(at(inputs.walls[0].thickness, 0, 0, 4), 1.24);
}

TEST(CaseWalls, OfPlacesFollowTheDesign) {
  const case_data::EvaluatedCase inputs =
      numbers_of(tube("films = [\"skin\"]\nthickness = \"1 + foot*z/1e3\"\n"));
  EXPECT_THAT(inputs.walls[0].thickness.names, ElementsAre("foot"));
  EXPECT_THAT(inputs.walls[0].thickness.numbers, ElementsAre(25.0));
  EXPECT_DOUBLE_EQ(at(inputs.walls[0].thickness, 0, 0, 4), 1.1);
}

class CaseWallsOf : public testing::TestWithParam<const char*> {};

// Inside is towards the axis however the film starts.
TEST_P(CaseWallsOf, CloseOnTheSettledFilm) {
  const TempFolder folder;
  const case_data::Case input =
      *reader::read_case_text(
           changed(tube("films = [\"skin\"]\nthickness = 2\n"
                        "side = \"inside\"\n"),
                   "kind = \"branch\"\ncurves = [\"base\", \"head\"]",
                   GetParam()),
           "case.toml")
           .input;
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      inputs.film_system, {.edge = inputs.fea_edge, .refinements = 1});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const auto walls =
      forward::make_walls(inputs, model, model.reference().points);
  ASSERT_EQ(walls.size(), 1U);
  const walls::ThickWall& wall = walls[0].wall;
  EXPECT_THAT(wall.findings, IsEmpty());
  EXPECT_THAT(wall.surface.labels,
              UnorderedElementsAre("skin", "skin/back", "skin/rim:base",
                                   "skin/rim:head"));
  EXPECT_NEAR(wall.volume, 2.0 * model.reference().report.area,
              0.03 * wall.volume);
  const auto radius = [&](std::size_t p) {
    return wall.surface.points[p].head<2>().norm();
  };
  std::vector<double> front(model.reference().points.size(), 0.0);
  for (std::size_t p = 0; p < wall.trace.size(); ++p) {
    if (wall.trace[p].vertex >= 0 && wall.trace[p].across == 1.0) {
      front[wall.trace[p].vertex] = radius(p);
    }
  }
  for (std::size_t p = 0; p < wall.trace.size(); ++p) {
    if (wall.trace[p].vertex >= 0 && wall.trace[p].across == 0.0) {
      EXPECT_LT(radius(p), front[wall.trace[p].vertex] - 1.0);  // to the axis
    }
  }
  EXPECT_GT(wall.safe.value, 2.0);
  EXPECT_THAT(forward::wall_text(input, walls[0]),
              HasSubstr("largest safe thickness"));
  forward::write_wall(input, walls[0], folder.path());
  EXPECT_GT(std::filesystem::file_size(folder.path() / "wall_web.stl"), 1000U);
  EXPECT_GT(std::filesystem::file_size(folder.path() / "wall_web.vtp"), 1000U);
}

INSTANTIATE_TEST_SUITE_P(
    AnyStart, CaseWallsOf,
    testing::Values("kind = \"branch\"\ncurves = [\"base\", \"head\"]",
                    "kind = \"loft\"\ncurves = [\"base\", \"head\"]",
                    "kind = \"loft\"\ncurves = [\"head\", \"base\"]"));

TEST(CaseWalls, OfAFlatFilmFollowTheCurve) {
  const std::string text =
      changed(changed(tube("films = [\"skin\"]\nthickness = 2\n"
                           "side = \"inside\"\n"),
                      "curves = [\"base\", \"head\"]", "curves = [\"base\"]"),
              "kind = \"branch\"", "kind = \"disk\"");
  const case_data::Case input =
      *reader::read_case_text(text, "case.toml").input;
  const case_data::EvaluatedCase inputs =
      case_data::evaluate(input, case_data::initial_design(input));
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(inputs.film_system, {.edge = inputs.fea_edge});
  const auto walls =
      forward::make_walls(inputs, model, model.reference().points);
  double highest = 0.0;  // the base's normal points down
  for (const Vec3& p : walls[0].wall.surface.points) {
    highest = std::max(highest, p.z());
  }
  EXPECT_NEAR(highest, 2.0, 0.05);
  EXPECT_NEAR(walls[0].wall.volume, 2.0 * model.reference().report.area,
              0.01 * walls[0].wall.volume);
}

TEST(CaseWalls, OfThreeFilmsAtALineAreJoined) {
  const std::string text =
      changed(tube("films = [\"skin\", \"floor\", \"cup\"]\nthickness = 1\n"),
              "[walls.web]",
              "[curves.bottom]\nkind = \"circle\"\ncenter = [0, 0, -15]\n"
              "normal = [0, 0, -1]\nradius = 20\n"
              "[films.floor]\nkind = \"disk\"\ncurves = [\"base\"]\n"
              "[films.cup]\nkind = \"loft\"\ncurves = [\"base\", "
              "\"bottom\"]\n[walls.web]");
  const case_data::EvaluatedCase inputs = numbers_of(text);
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(inputs.film_system, {.edge = inputs.fea_edge});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const auto walls =
      forward::make_walls(inputs, model, model.reference().points);
  ASSERT_EQ(walls.size(), 1U);
  EXPECT_THAT(walls[0].wall.findings, IsEmpty())
      << summary(walls[0].wall.findings);
  EXPECT_THAT(
      walls[0].wall.surface.labels,
      UnorderedElementsAre("skin", "floor", "cup", "skin/back", "floor/back",
                           "cup/back", "skin/rim:head", "cup/rim:bottom"));
  EXPECT_NEAR(walls[0].wall.volume, model.reference().report.area,
              0.03 * walls[0].wall.volume);
}

}  // namespace
}  // namespace meniscus::case_films_test
