/// Our displacements and stresses against CalculiX's (SPOOLES) on the same
/// mesh, under CalculiX's own loads: *DLOAD pressure, gravity and centrifugal
/// force, *TEMPERATURE with *EXPANSION, ENGINEERING CONSTANTS.
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fea/elastic/elasticity.h"
#include "fea/element/point_stress.h"
#include "fea/loads/body_loads.h"
#include "io/deck/deck_reader.h"
#include "pipeline/decks/deck_part.h"
#include "pipeline/decks/solve_deck.h"
#include "pipeline/results/calculix_export.h"
#include "tests/support/calculix.h"
#include "tests/support/not_here.h"
#include "tests/support/shapes.h"

namespace meniscus::calculix_loads_test {
namespace {

// CalculiX prints seven digits.
constexpr double kDisplacement = 1e-6;  // of the largest
constexpr double kStress = 1e-5;        // of the largest

constexpr double kPi = 3.14159265358979323846;

/// A sector of a thick tube, curved with ten nodes.
TetMesh tube(int order) {
  TetMesh mesh = shapes::brick({20.0, 0.5 * kPi, 30.0}, 3, 5, 4);
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  for (Vec3& x : mesh.nodes) {
    const double r = 20.0 + x.x();
    x = Vec3(r * std::cos(x.y()), r * std::sin(x.y()), x.z());
  }
  return mesh;
}

/// Two legs of 50 with a section of 10 x 15, mitred at the corner: x0 is the
/// end of the lying leg, x1 that of the standing one.
TetMesh bracket(int order) {
  TetMesh mesh = shapes::brick({80.0, 10.0, 15.0}, 12, 3, 3);
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  for (Vec3& x : mesh.nodes) {
    const double across = 5.0 - x.y();
    x = x.x() <= 40.0
            ? Vec3(x.x() / 40.0 * (40.0 + across), x.y(), x.z())
            : Vec3(40.0 + across,
                   x.y() + (x.x() - 40.0) / 40.0 * (40.0 + across), x.z());
  }
  return mesh;
}

TetMesh brick(int order) {
  const TetMesh mesh = shapes::brick({20.0, 30.0, 40.0}, 3, 4, 5);
  return order == 1 ? mesh : shapes::straight_quadratic(mesh);
}

struct Part {
  std::string name;
  TetMesh (*make)(int order);
  std::string foot;  // held
  std::string head;  // loaded
  std::string side;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> kParts = {
      {"Brick", brick, "z0", "z1", "x1"},
      {"Tube", tube, "y0", "y1", "x0"},
      {"Bracket", bracket, "x0", "x1", "y0"}};
  return kParts;
}

element::Material aluminium() {
  element::Material m{"aluminium", 71700.0, 0.33, 2.8e-9, {}};
  m.thermal_expansion.setConstant(2.3e-5);
  return m;
}

element::Material laminate() {
  element::Material m{"laminate", 0.0, 0.0, 1.6e-9, {}};
  m.orthotropic = element::Orthotropic{{120000.0, 9000.0, 7000.0},
                                       {0.3, 0.25, 0.4},
                                       {4500.0, 4000.0, 3000.0},
                                       {{1.0, 0.4, 0.2}, {-0.3, 1.0, 0.5}}};
  m.thermal_expansion = {1e-6, 2.5e-5, 3e-5};
  return m;
}

/// Force, pressure, gravity and spin, temperature.
std::vector<loads::LoadCase> load_cases(const Part& part) {
  loads::LoadCase force;
  force.name = "force";
  force.supports = {{part.foot, true, true, true}};
  loads::LoadCase pressure = force;
  loads::LoadCase weight = force;
  loads::LoadCase heat = force;
  force.forces = {{part.head, {300.0, -200.0, 500.0}}};
  pressure.name = "pressure";
  pressure.pressures = {{part.side, 3.0}};
  weight.name = "weight";
  weight.gravity = {2000.0, -3000.0, -9810.0};
  weight.spin = loads::Spin{{5.0, -3.0, 2.0}, {1.0, 0.5, 2.0}, 300.0};
  heat.name = "heat";
  heat.temperature = loads::Temperature{
      .field =
          [](const Vec3& x) {
            return 80.0 + 1.5 * x.x() - 0.7 * x.y() + 0.02 * x.z() * x.z();
          },
      .reference = 20.0};
  return {force, pressure, weight, heat};
}

struct Job {
  int part;
  int order;
  bool orthotropic;
};

class InCalculix : public testing::TestWithParam<Job> {};

TEST_P(InCalculix, EveryLoadGivesTheSameDisplacementsAndStresses) {
  if (!have_calculix()) {
    MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
  }
  const Part& part = parts()[GetParam().part];
  const TetMesh mesh = part.make(GetParam().order);
  const element::Material material =
      GetParam().orthotropic ? laminate() : aluminium();
  const std::vector<loads::LoadCase> cases = load_cases(part);
  io::CalculixDeck deck = results::calculix_deck_of({material}, cases, mesh);
  deck.output = io::DeckOutput::Print;
  const auto theirs = run_calculix(io::calculix_deck(mesh, deck),
                                   static_cast<int>(mesh.nodes.size()));
  ASSERT_EQ(theirs.size(), cases.size());
  const elastic::ElasticModel model(mesh, {material}, cases,
                                    {.tolerance = 1e-11});
  ASSERT_FALSE(model.base_solution().failure)
      << model.base_solution().failure->message;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const VectorX& u = model.base_solution().displacements[c];
    const double apart = relative_difference(u, theirs[c].displacement);
    EXPECT_LE(apart, kDisplacement) << cases[c].name;
    const element::PointStress stress = element::point_stress(
        mesh, {material}, u, loads::temperature_change(mesh, cases[c]));
    const double stress_apart =
        relative_difference(stress.stress, theirs[c].stress);
    EXPECT_LE(stress_apart, kStress) << cases[c].name;
    RecordProperty(cases[c].name + "_displacement", std::to_string(apart));
    RecordProperty(cases[c].name + "_stress", std::to_string(stress_apart));
  }
}

// Edges between sliding planes and the corner: two and three equations a node.
TEST(ObliqueInCalculix, SlidingPlanesGiveTheSameDisplacements) {
  if (!have_calculix()) {
    MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
  }
  TetMesh mesh = brick(2);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized())
                        .toRotationMatrix();
  for (Vec3& x : mesh.nodes) {
    x = turn * x;
  }
  loads::LoadCase load_case;
  load_case.name = "slide";
  load_case.supports = {{.surface = "x0", .kind = loads::SupportKind::Normal},
                        {.surface = "y0", .kind = loads::SupportKind::Symmetry},
                        {.surface = "z0", .kind = loads::SupportKind::Normal}};
  load_case.pressures = {{"z1", 5.0}};
  load_case.gravity = {0.0, 0.0, -9.81e6};
  io::CalculixDeck deck =
      results::calculix_deck_of({aluminium()}, {load_case}, mesh);
  deck.output = io::DeckOutput::Print;
  const auto theirs = run_calculix(io::calculix_deck(mesh, deck),
                                   static_cast<int>(mesh.nodes.size()));
  const elastic::ElasticModel model(mesh, {aluminium()}, {load_case});
  const VectorX& u = model.base_solution().displacements[0];
  EXPECT_LE(relative_difference(u, theirs.at(0).displacement), kDisplacement);
}

/// Beds of every kind under two of three load cases; the third is clamped.
std::vector<loads::LoadCase> on_springs(const Part& part) {
  loads::LoadCase components{.name = "components"};
  components.springs = {{part.foot, {40.0, 25.0, 60.0}},
                        {.surface = part.side, .normal = 3.0}};
  components.forces = {{part.head, {300.0, -200.0, 500.0}}};
  loads::LoadCase clamped{.name = "clamped"};
  clamped.supports = {{part.foot, true, true, true}};
  clamped.pressures = {{part.side, 3.0}};
  loads::LoadCase oblique{.name = "oblique"};
  oblique.springs = {
      {.surface = part.foot,
       .components = {9e4, 4e4, 7e4},
       .measure = loads::SpringMeasure::Total,
       .axes = element::LocalAxes{{1.0, 0.4, 0.2}, {-0.3, 1.0, 0.5}}}};
  oblique.gravity = {2000.0, -3000.0, -9810.0};
  loads::LoadCase again = oblique;
  again.name = "again";
  again.forces = {{part.head, {10.0, 20.0, -30.0}}};
  return {components, clamped, oblique, again};
}

/// Of each step of the deck CalculiX's displacements and ours.
void expect_same(const TetMesh& mesh, io::CalculixDeck deck,
                 const std::vector<loads::LoadCase>& cases,
                 const std::string& name) {
  deck.output = io::DeckOutput::Print;
  const auto theirs = run_calculix(io::calculix_deck(mesh, deck),
                                   static_cast<int>(mesh.nodes.size()));
  ASSERT_EQ(theirs.size(), cases.size());
  for (std::size_t c = 0; c < cases.size(); ++c) {
    // A model takes load cases that are held alike.
    const elastic::ElasticModel model(mesh, {aluminium()}, {cases[c]},
                                      {.tolerance = 1e-11});
    ASSERT_FALSE(model.base_solution().failure)
        << model.base_solution().failure->message;
    const double apart = relative_difference(
        model.base_solution().displacements[0], theirs[c].displacement);
    EXPECT_LE(apart, kDisplacement) << name << " " << cases[c].name;
    ::testing::Test::RecordProperty(name + cases[c].name,
                                    fmt::format("{:.1e}", apart));
  }
}

TEST(SpringsInCalculix, GiveTheSameDisplacementsInEveryStep) {
  if (!have_calculix()) {
    MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
  }
  for (const Part& part : parts()) {
    for (const int order : {1, 2}) {
      const TetMesh mesh = part.make(order);
      const std::vector<loads::LoadCase> cases = on_springs(part);
      const io::CalculixDeck deck =
          results::calculix_deck_of({aluminium()}, cases, mesh);
      EXPECT_EQ(deck.springs.size(), 7U);  // 3 + 1, 3 for two load cases
      expect_same(mesh, deck, cases, part.name + std::to_string(order));
    }
  }
}

/// A pin that is pulled; that is moved and turned; that is held in part, about
/// oblique axes (with the same frame); and a foot that is moved.
std::vector<loads::LoadCase> on_pins(const Part& part) {
  const element::LocalAxes axes{{1.0, 0.4, 0.2}, {-0.3, 1.0, 0.5}};
  loads::LoadCase pulled{.name = "pulled"};
  pulled.supports = {{part.foot, true, true, true}};
  pulled.pins = {{.surfaces = part.head}};
  pulled.remote_loads = {{.surfaces = part.head,
                          .point = {4.0, 30.0, 50.0},
                          .force = {300.0, -200.0, 500.0},
                          .moment = {1000.0, 2000.0, -500.0}}};
  pulled.gravity = {2000.0, -3000.0, -9810.0};
  loads::LoadCase moved = pulled;
  moved.name = "moved";
  moved.remote_loads.clear();
  moved.pins = {{.surfaces = part.head,
                 .fix = {true, true, true},
                 .fix_rotation = {true, true, true},
                 .axes = axes,
                 .point = {4.0, 30.0, 50.0},
                 .displacement = Vec3(0.02, -0.03, 0.01),
                 .rotation = Vec3(1e-3, -5e-4, 2e-3)}};
  loads::LoadCase hinged = moved;
  hinged.name = "hinged";
  hinged.pins[0].fix_rotation = {true, false, true};
  hinged.pins[0].fix = {true, false, true};
  hinged.pins[0].displacement = Vec3(0.01, 0.0, 0.02);
  hinged.pins[0].rotation = Vec3(1e-3, 0.0, 5e-4);
  hinged.supports[0].displacement = Vec3(0.005, -0.01, 0.02);
  return {pulled, moved, hinged};
}

TEST(PinsInCalculix, GiveTheSameDisplacementsInEveryStep) {
  if (!have_calculix()) {
    MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
  }
  for (const Part& part : parts()) {
    for (const int order : {1, 2}) {
      const TetMesh mesh = part.make(order);
      const std::vector<loads::LoadCase> cases = on_pins(part);
      const io::CalculixDeck deck =
          results::calculix_deck_of({aluminium()}, cases, mesh);
      EXPECT_EQ(deck.pins.size(), 1U);
      expect_same(mesh, deck, cases, part.name + std::to_string(order));
    }
  }
}

TEST(EnforcedInCalculix, MovedSurfacesGiveTheSameDisplacementsAndStresses) {
  if (!have_calculix()) {
    MENISCUS_NOT_HERE("ccx (Debian package calculix-ccx) is not installed");
  }
  for (const Part& part : parts()) {
    const TetMesh mesh = part.make(2);
    loads::LoadCase moved{.name = "moved"};
    moved.supports = {{part.foot, true, true, true},
                      {.surface = part.head,
                       .fix_x = true,
                       .fix_z = true,
                       .displacement = Vec3(0.05, 0.0, -0.02)}};
    moved.pressures = {{part.side, 3.0}};
    if (part.name == "Tube") {  // has a bore
      moved.bearings = {{.surfaces = "x0", .force = {400.0, 250.0, 30.0}}};
    }
    io::CalculixDeck deck =
        results::calculix_deck_of({aluminium()}, {moved}, mesh);
    deck.output = io::DeckOutput::Print;
    const auto theirs = run_calculix(io::calculix_deck(mesh, deck),
                                     static_cast<int>(mesh.nodes.size()));
    ASSERT_EQ(theirs.size(), 1U);
    const elastic::ElasticModel model(mesh, {aluminium()}, {moved},
                                      {.tolerance = 1e-11});
    const VectorX& u = model.base_solution().displacements[0];
    EXPECT_LE(relative_difference(u, theirs[0].displacement), kDisplacement);
    EXPECT_LE(relative_difference(
                  element::point_stress(mesh, {aluminium()}, u).stress,
                  theirs[0].stress),
              kStress);
    // The same deck read back: node by node.
    const decks::DeckResult read =
        decks::solve_deck(decks::make_deck_part(deck::read_deck_text(
                              io::calculix_deck(mesh, deck), "moved.inp")),
                          nullptr);
    EXPECT_LE(relative_difference(read.fields.solution.displacements[0],
                                  theirs[0].displacement),
              kDisplacement);
  }
}

std::vector<Job> jobs() {
  std::vector<Job> all;
  for (int part = 0; part < 3; ++part) {
    for (const int order : {1, 2}) {
      for (const bool orthotropic : {false, true}) {
        all.push_back({part, order, orthotropic});
      }
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Parts, InCalculix, testing::ValuesIn(jobs()),
                         [](const auto& job) {
                           return parts()[job.param.part].name +
                                  (job.param.order == 1 ? "Tet4" : "Tet10") +
                                  (job.param.orthotropic ? "Orthotropic"
                                                         : "Isotropic");
                         });

}  // namespace
}  // namespace meniscus::calculix_loads_test
