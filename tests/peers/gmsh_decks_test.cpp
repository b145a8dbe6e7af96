/// Decks that Gmsh meshed from a STEP part, solved by us and by CalculiX
/// (SPOOLES, ARPACK): several steps, C3D4 and C3D10.
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/child_process.h"
#include "core/find_program.h"
#include "core/timer.h"
#include "pipeline/decks/solve_deck.h"
#include "tests/support/calculix.h"
#include "tests/support/not_here.h"
#include "tests/support/temp_folder.h"

namespace meniscus::gmsh_decks_test {
namespace {

// CalculiX prints seven digits.
constexpr double kDisplacement = 1e-6;  // of the largest
constexpr double kStress = 1e-5;        // of the largest
constexpr double kEigenvalue = 1e-5;

constexpr const char* kPlate = R"(SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 60, 20, 6};
Cylinder(2) = {15, 10, -1, 0, 0, 8, 5};
Cylinder(3) = {50, 10, -1, 0, 0, 8, 3};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
)";
constexpr const char* kMesh = R"(SetFactory("OpenCASCADE");
Merge "plate.step";
Physical Volume("body") = Volume{:};
Physical Surface("foot") = Surface In BoundingBox {-1, -1, -1, 1, 21, 7};
Physical Surface("tip") = Surface In BoundingBox {59, -1, -1, 61, 21, 7};
Physical Surface("hole") = Surface In BoundingBox {9, 4, -1, 21, 16, 7};
)";
constexpr const char* kSteps = R"(*MATERIAL, NAME=alloy
*ELASTIC
71700., 0.33
*DENSITY
2.8e-9
*SOLID SECTION, ELSET=body, MATERIAL=alloy
*SURFACE, NAME=some_faces
body, S2
*BOUNDARY
foot, 1, 3
*STEP
*STATIC
*CLOAD
tip, 3, -1.
*NODE PRINT, NSET=body
U
*EL PRINT, ELSET=body, GLOBAL=YES
S
*END STEP
*STEP
*STATIC
*CLOAD
tip, 1, 2.
tip, 1, 0.5
*DLOAD
body, GRAV, 9810., 0.3, -1., 0.2
body, P1, 0.4
*NODE PRINT, NSET=body
U
*EL PRINT, ELSET=body, GLOBAL=YES
S
*END STEP
*STEP
*STATIC
*BOUNDARY
hole, 2
*CLOAD, OP=NEW
tip, 2, 3.
*DLOAD
body, CENTRIF, 1.e4, 3., 4., 0., 0., 0., 2.
*DSLOAD
some_faces, P, 1.5
*NODE PRINT, NSET=body
U
*EL PRINT, ELSET=body, GLOBAL=YES
S
*END STEP
)";

struct MeshedPart {
  int order;
  const char* edge;
};

class GmshDecks : public testing::TestWithParam<MeshedPart> {
 protected:
  void SetUp() override {
    if (!have_calculix() || !find_program("gmsh")) {
      MENISCUS_NOT_HERE(
          "ccx and gmsh (Debian packages calculix-ccx, gmsh) are "
          "not both installed");
    }
    write_file(folder_ / "plate.geo", kPlate);
    write_file(folder_ / "mesh.geo", kMesh);
    gmsh({"plate.geo", "-0", "-format", "step", "-o", "plate.step"});
    gmsh({"mesh.geo", "-3", "-order", std::to_string(GetParam().order),
          "-clmax", GetParam().edge, "-setnumber", "Mesh.SaveGroupsOfNodes",
          "1", "-format", "inp", "-o", "mesh.inp"});
    mesh_ = read_file(folder_ / "mesh.inp");
  }

  void gmsh(std::vector<std::string> arguments) const {
    ChildOptions options;
    options.argv = {"gmsh"};
    options.argv.insert(options.argv.end(), arguments.begin(), arguments.end());
    options.folder = folder_.path();
    options.time_limit = 120.0;
    const ChildResult result = run_child(options);
    if (!result.succeeded()) {
      throw std::runtime_error("gmsh " + describe_end(result) + result.output);
    }
  }

  /// The mesh without the elements of surfaces, which CalculiX would take for
  /// plane stress.
  std::string for_calculix() const {
    std::istringstream lines(mesh_);
    std::string text;
    bool kept = true;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("*")) {
        kept = line.find("CPS") == std::string::npos;
      }
      text += kept ? line + "\n" : "";
    }
    return text;
  }

  static decks::DeckResult solve(const std::string& text) {
    return decks::solve_deck(
        decks::make_deck_part(deck::read_deck_text(text, "plate.inp")),
        nullptr);
  }

  /// Of our numbering, from one by numbers of the deck.
  static VectorX ordered(const VectorX& of_number,
                         const std::vector<int>& numbers) {
    VectorX u(static_cast<Eigen::Index>(3 * numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      u.segment<3>(3L * i) = of_number.segment<3>(3L * (numbers[i] - 1));
    }
    return u;
  }

  TempFolder folder_;
  std::string mesh_;
};

TEST_P(GmshDecks, StaticStepsAreTheSame) {
  const Timer ours_timer;
  const decks::DeckResult ours = solve(mesh_ + kSteps);
  const double our_seconds = ours_timer.seconds();
  const int last =
      *std::max_element(ours.node_numbers.begin(), ours.node_numbers.end());
  const Timer theirs_timer;
  const std::vector<CalculixStep> theirs =
      run_calculix(for_calculix() + kSteps, last);
  std::printf("%zu nodes: %.3g of CalculiX's time\n", ours.node_numbers.size(),
              our_seconds / theirs_timer.seconds());
  ASSERT_EQ(theirs.size(), 3U);
  for (std::size_t s = 0; s < theirs.size(); ++s) {
    EXPECT_LE(
        relative_difference(ours.fields.solution.displacements[s],
                            ordered(theirs[s].displacement, ours.node_numbers)),
        kDisplacement)
        << s;
    EXPECT_LE(relative_difference(ours.fields.stresses[s].points.stress,
                                  theirs[s].stress),
              kStress)
        << s;
  }
}

/// The one step of a deck, its procedure's lines and its loads.
std::string one_step(const std::string& procedure, const std::string& loads) {
  const std::string steps = kSteps;
  return steps.substr(0, steps.find("*STEP")) + "*STEP\n" + procedure + loads +
         "*END STEP\n";
}

TEST_P(GmshDecks, FrequenciesAreTheSame) {
  const decks::DeckResult ours = solve(mesh_ + one_step("*FREQUENCY\n6\n", ""));
  const std::vector<double> theirs = run_calculix_eigenvalues(
      for_calculix() + one_step("*STATIC, SOLVER=SPOOLES\n", ""),
      "*FREQUENCY\n6");
  ASSERT_EQ(theirs.size(), 6U);
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    const double square = std::pow(
        2.0 * std::numbers::pi * ours.steps[0].frequencies->frequencies.at(k),
        2);
    EXPECT_NEAR(square / theirs[k], 1.0, kEigenvalue) << k;
  }
}

TEST_P(GmshDecks, BucklingFactorsAreTheSame) {
  const std::string loads = "*CLOAD\ntip, 1, -10.\n";
  const decks::DeckResult ours = solve(mesh_ + one_step("*BUCKLE\n2\n", loads));
  const std::vector<double> theirs = run_calculix_eigenvalues(
      for_calculix() + one_step("*STATIC, SOLVER=SPOOLES\n", loads),
      "*BUCKLE\n2,1e-8,20,1000");
  ASSERT_EQ(theirs.size(), 2U);
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    EXPECT_NEAR(ours.steps[0].buckling->factors.at(k) / theirs[k], 1.0,
                kEigenvalue)
        << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Parts, GmshDecks, testing::Values(MeshedPart{1, "2"}, MeshedPart{2, "4"}),
    [](const auto& part) { return part.param.order == 1 ? "C3D4" : "C3D10"; });

}  // namespace
}  // namespace meniscus::gmsh_decks_test
