#include "pipeline/results/datafile.h"

#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "tests/support/temp_folder.h"

namespace meniscus::datafile_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A square rim with a vertex in its middle.
const std::string kSquare =
    "vertices\n1 0 0 0 fixed\n2 1 0 0 fixed\n3 1 1 0 fixed\n4 0 1 0 fixed\n"
    "5 .5 .5 .2\n"
    "edges\n1 1 2 fixed\n2 2 3 fixed\n3 3 4 fixed\n4 4 1 fixed\n"
    "5 1 5\n6 2 5\n7 3 5\n8 4 5\n"
    "faces\n1 1 6 -5\n2 2 7 -6\n3 3 8 -7\n4 4 5 -8\n";

// Twelve triangles from the centre of an octahedron to its edges: four films
// meet along each of six lines, and all at the centre.
std::string octahedron() {
  std::string text =
      "vertices\n1 0 0 0\n2 1 0 0 fixed\n3 0 1 0 fixed\n4 -1 0 0 fixed\n"
      "5 0 -1 0 fixed\n6 0 0 1 fixed\n7 0 0 -1 fixed\nedges\n";
  int rims[12][2] = {{2, 3}, {3, 4}, {4, 5}, {5, 2}, {2, 6}, {3, 6},
                     {4, 6}, {5, 6}, {7, 2}, {7, 3}, {7, 4}, {7, 5}};
  int edge = 0;
  for (const auto& [a, b] : rims) {
    text += std::to_string(++edge) + " " + std::to_string(a) + " " +
            std::to_string(b) + " fixed\n";
  }
  for (int corner = 2; corner <= 7; ++corner) {
    text += std::to_string(++edge) + " 1 " + std::to_string(corner) + "\n";
  }
  text += "faces\n";
  int face = 0;
  for (const auto& [a, b] : rims) {
    ++face;
    text += std::to_string(face) + " " + std::to_string(a + 11) + " " +
            std::to_string(face) + " " + std::to_string(-(b + 11)) + "\n";
  }
  return text;
}

results::DatafileResult evolved(const std::string& text,
                                const results::DatafileOptions& options) {
  const TempFolder folder;
  std::ofstream(folder / "film.fe") << text;
  return results::evolve_datafile(folder / "film.fe", options);
}

std::string refusal(const std::string& text,
                    const results::DatafileOptions& options) {
  try {
    evolved(text, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Datafile, RefinementsBeyondTheMachineAreRefused) {
  // Four facets make 64 at two refinements and 67 million at twelve.
  EXPECT_EQ(evolved(kSquare, {.refinements = 2}).report.facets, 64U);
  EXPECT_THAT(refusal(kSquare, {.refinements = 12}),
              HasSubstr("12 refinements make 6.7e+07 facets"));
}

TEST(Datafile, RunsCommandsThatStandOutsideOfMacros) {
  const results::DatafileOptions options{.refinements = 0};
  EXPECT_EQ(evolved(kSquare, options).report.facets, 4U);
  const results::DatafileResult refined =
      evolved(kSquare + "read\nr 2\nprintf \"%d\\n\", facet_count\n", options);
  EXPECT_EQ(refined.report.facets, 64U);
  EXPECT_EQ(refined.printed, "64\n");
}

TEST(Datafile, SaysHowFilmsLieToEachOther) {
  EXPECT_THAT(results::datafile_text(evolved(kSquare, {})),
              Not(HasSubstr("apart")));
  // A second square, 0.25 above the first.
  const std::string two =
      "vertices\n1 0 0 0 fixed\n2 1 0 0 fixed\n3 1 1 0 fixed\n4 0 1 0 "
      "fixed\n5 0 0 .25 fixed\n6 1 0 .25 fixed\n7 1 1 .25 fixed\n8 0 1 .25 "
      "fixed\nedges\n1 1 2 fixed\n2 2 3 fixed\n3 3 4 fixed\n4 4 1 fixed\n"
      "5 5 6 fixed\n6 6 7 fixed\n7 7 8 fixed\n8 8 5 fixed\n"
      "faces\n1 1 2 3 4\n2 5 6 7 8\n";
  const results::DatafileResult result = evolved(two, {});
  ASSERT_FALSE(result.failure) << result.failure->message;
  EXPECT_TRUE(result.nesting.apart);
  EXPECT_THAT(results::datafile_text(result), HasSubstr("least gap 0.25,"));
  const TempFolder folder;
  results::write_datafile_result(result, "two", folder.path());
  const auto json = nlohmann::json::parse(read_file(folder / "film.json"));
  ASSERT_EQ(json.at("nesting").at("gaps").size(), 1U);
  EXPECT_DOUBLE_EQ(json.at("nesting").at("gaps")[0].at("gap"), 0.25);
}

TEST(Datafile, LeavesMacrosAloneUnlessAsked) {
  const std::string text = kSquare + "read\ngogo := { r; r }\ntwice := { r }\n";
  EXPECT_EQ(evolved(text, {.refinements = 0}).report.facets, 4U);
  EXPECT_EQ(evolved(text, {.macro = "gogo"}).report.facets, 64U);
  EXPECT_EQ(evolved(text, {.macro = "twice"}).report.facets, 16U);
}

TEST(Datafile, RefusesCommandsThatItDoesNotKnowByPlace) {
  EXPECT_THAT(refusal(kSquare + "read\nr\nload_marker\n", {}),
              HasSubstr("film.fe:23:1: command 'load_marker'"));
  EXPECT_THAT(refusal(kSquare + "read\nset facets nonsense 3\n", {}),
              HasSubstr("film.fe:22:"));
}

TEST(Datafile, PopsAnOctahedronToItsLowestFilm) {
  const results::DatafileResult cone = evolved(octahedron(), {});
  ASSERT_TRUE(cone.failure);
  EXPECT_EQ(cone.failure->kind, FailureKind::FilmUnstable);
  const results::DatafileResult popped = evolved(octahedron(), {.pop = true});
  EXPECT_FALSE(popped.failure) << popped.report.verdict;
  EXPECT_EQ(popped.report.verdict, "stable");
  EXPECT_GT(popped.popped, 0);
  // A flat film, so to the last digits: 4 sqrt(2) for corners at 1.
  EXPECT_NEAR(popped.report.energy, std::sqrt(32.0), 1e-12);
}

TEST(Datafile, PopsAPinchedNeckIntoTwoDisks) {
  // Hexagons of radius 1, 2 apart: beyond the last catenoid.
  std::string text = "vertices\n";
  for (int ring = 0; ring < 2; ++ring) {
    for (int k = 0; k < 6; ++k) {
      text += std::to_string(6 * ring + k + 1) + " " +
              std::to_string(std::cos(k * M_PI / 3.0)) + " " +
              std::to_string(std::sin(k * M_PI / 3.0)) + " " +
              std::to_string(2 * ring) + " fixed\n";
    }
  }
  std::string edges = "edges\n";
  std::string faces = "faces\n";
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    edges += std::to_string(k + 1) + " " + std::to_string(k + 1) + " " +
             std::to_string(next + 1) + " fixed\n" + std::to_string(k + 7) +
             " " + std::to_string(k + 7) + " " + std::to_string(next + 7) +
             " fixed\n" + std::to_string(k + 13) + " " + std::to_string(k + 1) +
             " " + std::to_string(k + 7) + "\n";
    faces += std::to_string(k + 1) + " " + std::to_string(k + 1) + " " +
             std::to_string(next + 13) + " " + std::to_string(-(k + 7)) + " " +
             std::to_string(-(k + 13)) + "\n";
  }
  const std::string file = text + edges + faces;
  const results::DatafileResult pinched = evolved(file, {});
  ASSERT_TRUE(pinched.failure);
  EXPECT_EQ(pinched.failure->kind, FailureKind::FilmPinched);
  const results::DatafileResult popped = evolved(file, {.pop = true});
  EXPECT_FALSE(popped.failure) << popped.report.verdict;
  // Vertices have six decimals in the file.
  EXPECT_NEAR(popped.report.energy, 3.0 * std::sqrt(3.0), 1e-5);
}

}  // namespace
}  // namespace meniscus::datafile_test
