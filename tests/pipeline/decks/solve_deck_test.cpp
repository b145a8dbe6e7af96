#include "pipeline/decks/solve_deck.h"

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json.h"
#include "fea/elastic/elasticity.h"
#include "pipeline/results/calculix_export.h"
#include "tests/support/parts.h"
#include "tests/support/temp_folder.h"

namespace meniscus::solve_deck_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Coordinates and forces have 13 digits in the deck.
constexpr double kWritten = 1e-9;

element::Material ply() {
  element::Material m{"ply", 0.0, 0.0, 1.6e-9, {}};
  m.orthotropic = element::Orthotropic{{120000.0, 9000.0, 7000.0},
                                       {0.3, 0.25, 0.4},
                                       {4500.0, 4000.0, 3000.0},
                                       {{1.0, 0.4, 0.2}, {-0.3, 1.0, 0.5}}};
  m.thermal_expansion = Vec3(1e-6, 2e-5, 3e-5);
  return m;
}

/// Held obliquely, on springs, heated, turning: all that our decks can say.
std::vector<loads::LoadCase> varied_cases() {
  loads::LoadCase slides{.name = "slides"};
  slides.supports = {{.surface = "y0", .kind = loads::SupportKind::Symmetry},
                     {.surface = "y1", .kind = loads::SupportKind::Symmetry},
                     {.surface = "x0", .kind = loads::SupportKind::Normal},
                     {.surface = "z0", .fix_z = true}};
  slides.pressures = {{"x1", 5.0}};
  slides.forces = {{"z1", {1.0, 2.0, 3.0}}};
  loads::LoadCase heated = slides;
  heated.name = "heated";
  heated.pressures.clear();
  heated.temperature = loads::Temperature{
      .value = 0.0,
      .field = [](const Vec3& x) { return 20.0 + 30.0 * x.x() + x.z(); },
      .reference = 5.0};
  heated.springs = {{"z1", {}, 2000.0}, {"x1", {50.0, 10.0, 0.0}}};
  loads::LoadCase turning = slides;
  turning.name = "turning";
  turning.forces.clear();
  turning.pressures.clear();
  turning.gravity = Vec3(1.0, -9.0, 2.0);
  turning.spin = loads::Spin{{0.5, 0.0, 0.0}, {0.0, 0.3, 2.0}, 300.0};
  return {slides, heated, turning};
}

struct RoundTrip {
  TetMesh mesh;
  std::vector<loads::LoadCase> load_cases;
  std::vector<element::Material> materials;
};

/// The same by a deck: our writer, our reader, our solver.
decks::DeckResult by_deck(const RoundTrip& job) {
  const io::CalculixDeck deck =
      results::calculix_deck_of(job.materials, job.load_cases, job.mesh);
  return decks::solve_deck(decks::make_deck_part(deck::read_deck_text(
                               io::calculix_deck(job.mesh, deck), "own.inp")),
                           nullptr);
}

void expect_same(const RoundTrip& job) {
  const elastic::ElasticModel model(job.mesh, job.materials, job.load_cases);
  const equations::ElasticSolution& ours = model.base_solution();
  ASSERT_FALSE(ours.failure);
  const decks::DeckResult read = by_deck(job);
  // What was read, written and read again: nodes and springs one by one.
  const decks::DeckResult again =
      by_deck({read.fields.mesh, read.fields.inputs.load_cases, job.materials});
  ASSERT_EQ(read.steps.size(), job.load_cases.size());
  for (std::size_t c = 0; c < job.load_cases.size(); ++c) {
    EXPECT_EQ(read.steps[c].name, job.load_cases[c].name);
    const VectorX& u = read.fields.solution.displacements[c];
    EXPECT_LE((u - ours.displacements[c]).lpNorm<Eigen::Infinity>(),
              kWritten * ours.displacements[c].lpNorm<Eigen::Infinity>())
        << job.load_cases[c].name;
    EXPECT_LE(
        (again.fields.solution.displacements[c] - u).lpNorm<Eigen::Infinity>(),
        kWritten * u.lpNorm<Eigen::Infinity>())
        << job.load_cases[c].name << ", again";
  }
}

TEST(SolveDeck, OurOwnDecksGiveTheSameDisplacements) {
  expect_same({parts::quarter_tube(3, 0.5), varied_cases(), {ply()}});
  loads::LoadCase pulled = parts::pulled({1.0, 2.0, 3.0});
  loads::LoadCase other = pulled;
  other.name = "other";
  other.supports = {{"y0", true, true, true}};
  other.pressures = {{"x1", 3.0}};
  const TetMesh brick = shapes::brick({2.0, 3.0, 4.0}, 3, 3, 3);
  loads::LoadCase moved{.name = "moved"};
  moved.supports = {{"x0", true, true, true},
                    {.surface = "x1",
                     .fix_x = true,
                     .fix_z = true,
                     .displacement = Vec3(0.02, 0.0, -0.01)}};
  expect_same({brick, {pulled, other, moved}, {parts::steel()}});
  TetMesh two = shapes::straight_quadratic(brick);
  for (int e = 0; e < two.element_count(); e += 2) {
    two.element_region[static_cast<std::size_t>(e)] = 1;
  }
  element::Material soft = parts::steel();
  soft.name = "soft";
  soft.youngs_modulus = 1000.0;
  expect_same({two, {pulled, other}, {parts::steel(), soft}});
}

/// A cube of five tetrahedra that stands on three nodes as on ice.
std::string cube(const std::string& steps) {
  return "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n"
         "5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n99,5,5,5\n"
         "*ELEMENT, TYPE=C3D4, ELSET=E\n"
         "1,1,2,4,5\n2,2,3,4,7\n3,5,7,6,2\n4,5,8,7,4\n5,2,4,5,7\n"
         "*NSET, NSET=FOOT\n1,2,3,4\n*NSET, NSET=TOP\n5,6,7,8\n"
         "*MATERIAL, NAME=M\n*ELASTIC\n100., 0.25\n*DENSITY\n2.\n"
         "*SOLID SECTION, ELSET=E, MATERIAL=M\n"
         "*BOUNDARY\nFOOT, 3\n1, 1, 2\n2, 2\n" +
         steps;
}

decks::DeckResult solve(const std::string& steps) {
  return decks::solve_deck(
      decks::make_deck_part(deck::read_deck_text(cube(steps), "cube.inp")),
      nullptr);
}

constexpr const char* kSteps =
    "*STEP\n*STATIC\n*DLOAD\n3, P1, 10.\n4, P1, 10.\n*NODE FILE\nU\n"
    "*END STEP\n*STEP\n*FREQUENCY\n2\n*END STEP\n"
    "*STEP, NAME=push\n*BUCKLE\n1\n*DLOAD\n3, P1, 1.\n4, P1, 1.\n*END STEP\n";

// Two faces make the top: uniaxial stress, exact.
TEST(SolveDeck, FiguresOfACubeUnderPressure) {
  const decks::DeckResult result = solve(kSteps);
  EXPECT_NEAR(result.volume, 1.0, 1e-14);
  EXPECT_NEAR(*result.mass, 2.0, 1e-14);
  ASSERT_EQ(result.steps.size(), 3U);
  EXPECT_LT((result.steps[0].load - Vec3(0, 0, -10)).norm(), 1e-12);
  EXPECT_LT((result.steps[0].reaction - Vec3(0, 0, 10)).norm(), 1e-10);
  EXPECT_NEAR(result.stress[0].max_von_mises, 10.0, 1e-8);
  const Vec3 far(0.025, 0.025, -0.1);
  EXPECT_NEAR(result.steps[0].largest_displacement, far.norm(), 1e-9);
  EXPECT_EQ(result.steps[0].largest_node, 7);
  ASSERT_TRUE(result.steps[1].frequencies);
  EXPECT_EQ(result.steps[1].frequencies->frequencies.size(), 2U);
  ASSERT_TRUE(result.steps[2].buckling);
  EXPECT_FALSE(result.steps[2].buckling->failure);
}

TEST(SolveDeck, EnforcedDisplacementsStretchACube) {
  const decks::DeckResult result = solve(
      "*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.02\n*END STEP\n"
      "*STEP\n*STATIC\n*END STEP\n"
      "*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, -0.01\n*END STEP\n");
  ASSERT_EQ(result.steps.size(), 3U);
  const std::vector<double> moved = {0.02, 0.02, -0.01};  // it stands
  for (std::size_t s = 0; s < moved.size(); ++s) {
    for (std::size_t i = 0; i < 8; ++i) {
      const Vec3& x = result.fields.mesh.nodes[i];
      const Vec3 exact = moved[s] * Vec3(-0.25 * x.x(), -0.25 * x.y(), x.z());
      EXPECT_LE((result.fields.solution.displacements[s].segment<3>(
                     static_cast<Eigen::Index>(3 * i)) -
                 exact)
                    .norm(),
                1e-9)
          << s;
    }
  }
}

TEST(SolveDeck, WritesItsFiles) {
  const decks::DeckResult result = solve(kSteps);
  const TempFolder folder;
  decks::write_deck_result(result, unit_system("mm-N-MPa"), "1.2",
                           folder.path());
  const auto json = parse_json(read_file(folder / "result.json"));
  EXPECT_EQ(json["units"]["pressure"], "MPa");
  EXPECT_EQ(json["steps"].size(), 3U);
  EXPECT_NEAR(json["steps"][0]["reaction"][2].get<double>(), 10.0, 1e-9);
  EXPECT_EQ(json["not_needed"][0], "*NODE FILE (cube.inp:36)");
  EXPECT_TRUE(std::filesystem::exists(folder / "part.vtu"));
  const std::string frd = read_file(folder / "part.frd");
  EXPECT_THAT(frd, AllOf(HasSubstr("\n -1         8 0.00000E+00"),
                         HasSubstr("\n -4  STRESS      6    1\n"),
                         HasSubstr("2MODAL      1\n"),
                         testing::EndsWith(" -3\n 9999\n")));
  EXPECT_THAT(frd, testing::Not(HasSubstr(" -1        99")));
  EXPECT_THAT(decks::deck_text(result, std::nullopt),
              AllOf(HasSubstr("in the deck's own units"), HasSubstr("node 7"),
                    HasSubstr("not needed")));
}

void expect_refusal(const std::string& steps, const std::string& line,
                    const std::string& says) {
  try {
    decks::make_deck_part(deck::read_deck_text(cube(steps), "cube.inp"));
    ADD_FAILURE() << "nothing refused; expected: " << says;
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("cube.inp:" + line), HasSubstr(says)));
  }
}

TEST(SolveDeck, RefusesByLineWhatCannotBeSolved) {
  expect_refusal("*STEP\n*STATIC\n*END STEP\n", "31:", "has no load");
  expect_refusal(
      "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n1,1,3\n*CLOAD\n7,1,1.\n*END STEP\n",
      "31:", "rotate about");
  expect_refusal("*STEP\n*STATIC\n*CLOAD\n99,1,1.\n*END STEP\n",
                 "35:", "in no element");
}

TEST(SolveDeck, MaterialsOutOfRangeAreToldByLine) {
  std::string text = cube(kSteps);
  text.replace(text.find("100., 0.25"), 10, "100., 0.50");
  try {
    decks::make_deck_part(deck::read_deck_text(text, "cube.inp"));
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("cube.inp:"), HasSubstr("'M'"),
                                    HasSubstr("0.5")));
  }
}

}  // namespace
}  // namespace meniscus::solve_deck_test
