/// Rigid pins and enforced displacements: closed forms, elimination by hand,
/// exact gradients.
#include "fea/supports/pins.h"

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/operation_count.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/energy_functionals.h"
#include "fea/functionals/stress_functionals.h"
#include "fea/loads/load_rates.h"
#include "fea/modes/modes.h"
#include "fea/supports/enforced.h"
#include "fea/supports/supports.h"
#include "tests/support/coupled_freedom.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::pins_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;
constexpr double kSolver = 1e-13;
constexpr double kExact = 1e-9;     // fields that elements have exactly
constexpr double kByHand = 1e-8;    // against a dense factor
constexpr double kBalance = 1e-9;   // reactions against loads
constexpr double kGradient = 3e-8;  // of solutions, see adjoint_test.cpp

VectorX solve(const TetMesh& mesh,
              const std::vector<element::Material>& materials,
              const loads::LoadCase& load_case,
              equations::SolverKind kind = equations::SolverKind::Automatic) {
  const elastic::ElasticModel model(mesh, materials, {load_case},
                                    {.solver = kind});
  const equations::ElasticSolution& solution = model.base_solution();
  EXPECT_FALSE(solution.failure) << solution.failure->message;
  EXPECT_LE(solution.report.reaction_imbalance, kBalance);
  return solution.displacements[0];
}

/// E^T K E by a dense factor.
VectorX by_hand(const TetMesh& mesh,
                const std::vector<element::Material>& materials,
                const loads::LoadCase& load_case) {
  const solver::ElementTable table = parts::table_of(mesh);
  solver::BlockMatrix<double> matrix;
  EXPECT_FALSE(solver::assemble(table, mesh.nodes,
                                element::elastic_laws(materials), matrix));
  const parts::CoupledFreedom freedom = parts::coupled_freedom(mesh, load_case);
  const Eigen::MatrixXd& E = freedom.columns;
  Eigen::MatrixXd KE(E.rows(), E.cols());
  for (Eigen::Index k = 0; k < E.cols(); ++k) {
    KE.col(k) = parts::product(table, matrix, E.col(k));
  }
  const VectorX right = loads::nodal_forces(mesh, load_case, materials) -
                        parts::product(table, matrix, freedom.enforced);
  const VectorX y =
      (E.transpose() * KE).eval().ldlt().solve(E.transpose() * right);
  return freedom.enforced + E * y;
}

/// On a free pin under a force off its middle and under weight.
loads::LoadCase on_a_pin() {
  loads::LoadCase load_case = gradient_parts::held("pin");
  load_case.pins = {{.surfaces = "x1"}};
  load_case.remote_loads = {{.surfaces = "x1",
                             .point = {3.0, 0.7, -0.4},
                             .force = {0.5, -1.0, 2.0},
                             .moment = {0.4, 0.3, -0.6}}};
  load_case.gravity = {0.3, -0.2, -0.8};
  return load_case;
}

/// One pin turns the part and holds it, the other is pulled.
loads::LoadCase between_pins() {
  loads::LoadCase load_case{.name = "two pins"};
  load_case.pins = {{.surfaces = "x0",
                     .fix = {true, true, true},
                     .fix_rotation = {true, false, true},
                     .point = {-0.3, 0.5, 0.4},
                     .displacement = Vec3(0.02, -0.01, 0.03),
                     .rotation = Vec3(0.02, 0.0, -0.015)},
                    {.surfaces = "x1",
                     .fix = {false, false, true},
                     .point = {1.8, 0.2, 0.1},
                     .displacement = Vec3(0.0, 0.0, -0.04)}};
  load_case.remote_loads = {{.surfaces = "x1",
                             .point = {2.0, 0.4, 0.3},
                             .force = {0.5, -1.0, 0.0},
                             .moment = {0.4, 0.3, -0.6}}};
  return load_case;
}

loads::LoadCase stretched() {
  loads::LoadCase load_case = gradient_parts::held("stretched");
  load_case.supports.push_back({.surface = "x1",
                                .fix_x = true,
                                .fix_z = true,
                                .displacement = Vec3(0.05, 0.0, -0.02)});
  load_case.forces = {{"z1", {0.1, 0.4, -0.3}}};
  return load_case;
}

class Pins : public testing::TestWithParam<int> {};

TEST_P(Pins, AreTheCouplingEliminatedByHand) {
  const TetMesh mesh = gradient_parts::block(GetParam());
  const std::vector<element::Material> materials = gradient_parts::materials();
  for (const loads::LoadCase& load_case :
       {on_a_pin(), between_pins(), stretched()}) {
    const VectorX exact = by_hand(mesh, materials, load_case);
    for (const auto kind :
         {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
      const VectorX u = solve(mesh, materials, load_case, kind);
      EXPECT_LE((u - exact).norm(), kByHand * exact.norm()) << load_case.name;
    }
  }
}

/// Total derivatives of functionals of different kinds by places.
TEST_P(Pins, TotalGradientsByPlacesAndNumbers) {
  const TetMesh mesh = gradient_parts::block(GetParam());
  const std::vector<element::Material> materials = gradient_parts::materials();
  const std::vector<char> all;
  const VectorX dx = derivatives::wave(mesh, 0.4);
  using Of = std::function<element::Functional(
      const TetMesh&, const loads::LoadCase&, const VectorX&)>;
  const std::vector<Of> functionals = {
      [](const TetMesh& m, const loads::LoadCase&, const VectorX& u) {
        return element::Functional(functionals::mean_displacement_functional(
            m, "x1", {0.5, 1.0, -1.0}, u));
      },
      [&](const TetMesh& m, const loads::LoadCase& c, const VectorX& u) {
        return functionals::compliance_functional(m, materials, c, u);
      },
      [&](const TetMesh& m, const loads::LoadCase& c, const VectorX& u) {
        return functionals::strain_energy_functional(m, materials, c, u);
      },
      [&](const TetMesh& m, const loads::LoadCase& c, const VectorX& u) {
        return functionals::von_mises_norm_functional({m, materials, c, u, all},
                                                      6.0);
      }};
  loads::LoadCase sprung = on_a_pin();
  sprung.name = "sprung";
  sprung.springs = {{.surface = "x1", .components = {1.0, 2.0, 3.0}}};
  for (const loads::LoadCase& load_case :
       {on_a_pin(), between_pins(), stretched(), sprung}) {
    const elastic::ElasticModel model(mesh, materials, {load_case},
                                      {.tolerance = kSolver});
    equations::ElasticState state;
    const equations::ElasticSolution solution =
        model.solve(mesh, {load_case}, &state);
    ASSERT_FALSE(solution.failure) << solution.failure->message;
    const VectorX& u = solution.displacements[0];
    // Rates of everything that the load case's holding numbers are.
    loads::LoadCase rates{.name = load_case.name};
    rates.supports = load_case.supports;
    rates.forces = {load_case.forces.size(), {"z1", {0.1, 0.3, 0.2}}};
    rates.remote_loads = {load_case.remote_loads.size(),
                          {"x1", {0.2, 0.3, 0.1}, {1, 2, 3}, {0.3, 0.1, -1}}};
    for (loads::Support& support : rates.supports) {
      support.displacement = Vec3(0.3, 0.0, -0.4);
    }
    for (const loads::RigidPin& pin : load_case.pins) {
      rates.pins.push_back(pin);
      rates.pins.back().point = {0.3, -0.2, 0.5};
      rates.pins.back().displacement = Vec3(0.2, 0.4, -0.3);
      rates.pins.back().rotation = Vec3(0.3, -0.2, 0.1);
    }
    const auto at = [&](double t) {
      loads::LoadCase c = load_case;
      for (std::size_t k = 0; k < c.forces.size(); ++k) {
        c.forces[k].total += t * rates.forces[k].total;
      }
      for (std::size_t k = 0; k < c.remote_loads.size(); ++k) {
        c.remote_loads[k].point += t * rates.remote_loads[k].point;
        c.remote_loads[k].force += t * rates.remote_loads[k].force;
        c.remote_loads[k].moment += t * rates.remote_loads[k].moment;
      }
      for (std::size_t k = 0; k < c.supports.size(); ++k) {
        c.supports[k].displacement =
            loads::value_of(load_case.supports[k].displacement) +
            t * *rates.supports[k].displacement;
      }
      for (std::size_t k = 0; k < c.pins.size(); ++k) {
        const loads::RigidPin& pin = load_case.pins[k];
        c.pins[k].point += t * rates.pins[k].point;
        c.pins[k].displacement =
            loads::value_of(pin.displacement) + t * *rates.pins[k].displacement;
        c.pins[k].rotation =
            loads::value_of(pin.rotation) + t * *rates.pins[k].rotation;
      }
      return c;
    };
    for (std::size_t f = 0; f < functionals.size(); ++f) {
      SCOPED_TRACE(load_case.name + ", functional " + std::to_string(f));
      const auto value = [&](const TetMesh& m, const loads::LoadCase& c) {
        const equations::ElasticSolution moved = model.solve(m, {c});
        EXPECT_FALSE(moved.failure) << moved.failure->message;
        return functionals[f](m, c, moved.displacements[0]).value;
      };
      const element::Functional here = functionals[f](mesh, at(0.0), u);
      const equations::AdjointSolution adjoint =
          model.solve_adjoint(state, 0, {here.by_displacement});
      ASSERT_FALSE(adjoint.failure) << adjoint.failure->message;
      const loads::AdjointPair pair{u, solution.reactions[0], adjoint.lambda[0],
                                    adjoint.reactions[0]};
      Points gradient =
          elastic::residual_gradient(mesh, materials, at(0.0), pair);
      flat(gradient) += flat(here.by_nodes);
      const double scale = flat(gradient).cwiseProduct(dx).lpNorm<1>();
      derivatives::expect_derivative(
          {.exact = flat(gradient).dot(dx),
           .scale = scale,
           .tolerance = kGradient},
          [&](double t) {
            return value(derivatives::moved(mesh, dx, t), at(0.0));
          });
      VectorX by_forces = adjoint.lambda[0];
      if (f == 1) {
        by_forces += u;  // the compliance is f . u
      }
      loads::LoadGradient by =
          loads::load_gradient(mesh, materials, at(0.0), by_forces);
      supports::add_enforced_gradient(mesh, at(0.0), pair, by.by_number);
      const double exact = loads::load_rate(by, rates);
      derivatives::expect_derivative(
          {.exact = exact,
           .scale = std::abs(exact) + std::abs(here.value),
           .tolerance = kGradient},
          [&](double t) { return value(mesh, at(t)); });
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, Pins, testing::Values(1, 2));

/// A bar that is stretched by its end: uniform stress, and the force E A e.
TEST(Enforced, EndOfABarStretchesItUniformly) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 2.0}, 4, 2, 3);
  loads::LoadCase load_case{.name = "stretch"};
  load_case.supports = {
      {.surface = "x0", .fix_x = true},
      {.surface = "y0", .fix_y = true},
      {.surface = "z0", .fix_z = true},
      {.surface = "x1", .fix_x = true, .displacement = Vec3(0.02, 0.0, 0.0)}};
  const element::Material steel = parts::steel();
  const elastic::ElasticModel model(mesh, {steel}, {load_case});
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  const double strain = 0.02 / 4.0;
  const double force = steel.youngs_modulus * 2.0 * strain;
  double pull = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    const Vec3 exact = strain * Vec3(x.x(), -steel.poisson_ratio * x.y(),
                                     -steel.poisson_ratio * x.z());
    const Vec3 u = solution.displacements[0].segment<3>(3L * i);
    EXPECT_LE((u - exact).norm(), kExact * 0.02);
    if (x.x() == 4.0) {
      pull += solution.reactions[0][3L * i];
    }
  }
  EXPECT_NEAR(pull, force, kExact * force);
  EXPECT_NEAR(solution.report.strain_energy, 0.5 * force * 0.02,
              kExact * force * 0.02);
  EXPECT_LE(solution.report.reaction_imbalance, kBalance);
  // No load does work.
  EXPECT_EQ(functionals::compliance_functional(mesh, {steel}, load_case,
                                               solution.displacements[0])
                .value,
            0.0);
}

/// A disc between a rigid hub that a moment turns and a rim that is held: pure
/// shear, u = B (1 / r - r / b^2), M = 4 pi G h B (Timoshenko, Goodier).
TEST(Pins, HubOfADiscTurnsAsInPureShear) {
  constexpr double kHeight = 0.5;
  constexpr double kMoment = 100.0;  // of a quarter
  const element::Material steel = parts::steel();
  const double G = steel.youngs_modulus / (2.0 * (1.0 + steel.poisson_ratio));
  const double exact =
      4.0 * kMoment / (4.0 * kPi * G * kHeight) * (1.0 - 1.0 / 4.0);
  std::vector<double> errors;
  for (const int n : {2, 4}) {
    const TetMesh mesh = parts::quarter_tube(n, kHeight);
    loads::LoadCase load_case{.name = "hub"};
    // Across the cuts, shear alone: what is along a cut is held.
    load_case.supports = {parts::hold("x1"),
                          {"y0", true, false, false},
                          {"y1", false, true, false},
                          {"z0", false, false, true},
                          {"z1", false, false, true}};
    load_case.pins = {{.surfaces = "x0",
                       .fix = {true, true, true},
                       .fix_rotation = {true, true, false}}};
    load_case.remote_loads = {
        {.surfaces = "x0", .moment = {0.0, 0.0, kMoment}}};
    const VectorX u = solve(mesh, {steel}, load_case);
    const supports::PinFrame pin = supports::pin_frames(mesh, load_case)[0];
    const supports::PinMotion motion = supports::motion_of(pin, mesh.nodes, u);
    EXPECT_LE(motion.displacement.norm(), kExact * exact);
    for (const int node : pin.nodes) {
      EXPECT_LE(
          (u.segment<3>(3L * node) - motion.rotation.cross(mesh.nodes[node]))
              .norm(),
          kExact * exact);
    }
    errors.push_back(std::abs(motion.rotation.z() / exact - 1.0));
  }
  EXPECT_LE(errors[1], 2e-4);
  EXPECT_GE(errors[0] / errors[1], 8.0);  // quadratic elements: order 4, or so
}

/// A rigid end carries what the bar's end carries: bending by an end moment.
TEST(Pins, RigidEndOfABarBendsItToACircle) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({10.0, 1.0, 1.0}, 20, 2, 2));
  element::Material material = parts::steel();
  material.poisson_ratio = 0.0;  // plane sections have this field exactly
  loads::LoadCase load_case{.name = "bend"};
  load_case.supports = {parts::hold("x0")};
  load_case.pins = {{.surfaces = "x1"}};
  load_case.remote_loads = {
      {"x1", {10.0, 0.5, 0.5}, Vec3::Zero(), {0.0, 700.0, 0.0}}};
  const VectorX u = solve(mesh, {material}, load_case);
  const supports::PinMotion motion = supports::motion_of(
      supports::pin_frames(mesh, load_case)[0], mesh.nodes, u);
  const double turn = 700.0 * 10.0 / (material.youngs_modulus / 12.0);
  EXPECT_NEAR(motion.rotation.y(), turn, 1e-8 * turn);
  EXPECT_NEAR(-motion.displacement.z(), turn * 5.0, 1e-8 * turn * 5.0);
}

/// A pin that only points are held by turns as it likes, however the part is
/// pulled.
TEST(Pins, AHeldPointLetsThePartSwing) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 1.0}, 8, 2, 2);
  loads::LoadCase load_case{.name = "swing"};
  load_case.pins = {{.surfaces = "x0",
                     .fix = {true, true, true},
                     .fix_rotation = {true, false, true},
                     .point = {0.0, 0.5, 0.5}}};
  load_case.supports = {{"x1", false, false, true}};
  load_case.forces = {{"z1", {0.0, 0.0, -8.0}}};
  const elastic::ElasticModel model(mesh, {parts::steel()}, {load_case});
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  double left = 0.0;
  double right = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const double r = solution.reactions[0][3L * i + 2];
    (mesh.nodes[i].x() < 2.0 ? left : right) += r;
  }
  EXPECT_NEAR(left, 4.0, 1e-7);  // a beam on two hinges
  EXPECT_NEAR(right, 4.0, 1e-7);
}

// The six motions of a pin are solved for once, whatever acts on it.
TEST(Pins, FourLoadCasesCostWhatOneCosts) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 1.0, 1.0}, 16, 5, 5));
  std::vector<loads::LoadCase> cases;
  for (int k = 0; k < 4; ++k) {
    loads::LoadCase& load_case =
        cases.emplace_back(gradient_parts::held(k == 0 ? "a" : "b"));
    load_case.name += std::to_string(k);
    load_case.pins = {{.surfaces = "x1"}};
    load_case.remote_loads = {
        {"x1", {5.0, 0.3 * k, 0.2}, {1.0, -2.0 * k, 3.0}, {0.0, 1.0, 0.5 * k}}};
  }
  const elastic::ElasticModel four(mesh, {parts::steel()}, cases);
  const elastic::ElasticModel one(mesh, {parts::steel()}, {cases[0]});
  const auto work = [&](const elastic::ElasticModel& model) {
    const double before = operations_done();
    EXPECT_FALSE(model.solve(mesh).failure);
    return operations_done() - before;
  };
  EXPECT_LE(work(four), 1.15 * work(one));
}

template <class Error>
void expect_refused(const loads::LoadCase& load_case, const char* one,
                    const char* two) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 1.0}, 4, 2, 2);
  EXPECT_THAT(
      [&] { elastic::ElasticModel(mesh, {parts::steel()}, {load_case}); },
      testing::ThrowsMessage<Error>(
          AllOf(HasSubstr(load_case.name), HasSubstr(one), HasSubstr(two))));
}

TEST(Pins, WhatDoesNotFitIsRefused) {
  loads::LoadCase load_case = gradient_parts::held("main");
  load_case.forces = {{"z1", {0.0, 0.0, 1.0}}};
  load_case.pins = {{.surfaces = "y0"}};
  expect_refused<InvalidInput>(load_case, "rigid pin of 'y0'",
                               "support on 'x0'");
  load_case.supports = {{"x0", true, false, false}};
  load_case.pins = {{.surfaces = "y0", .fix = {true, true, true}}};
  expect_refused<InvalidInput>(load_case, "rigid pin of 'y0'", "fix_rotation");
  load_case.supports.clear();
  load_case.pins = {{.surfaces = "y0"}, {.surfaces = "x1"}};
  expect_refused<InvalidInput>(load_case, "share the node", "one pin");
  load_case.pins = {{.surfaces = "y0"}};
  expect_refused<InvalidInput>(load_case, "has no support", "fix");
  load_case.pins = {{.surfaces = "y0", .fix = {true, true, true}}};
  expect_refused<SolverError>(load_case, "rotate", "too weak");
  load_case.pins = {{.surfaces = "lid"}};
  EXPECT_THROW(elastic::ElasticModel(shapes::brick({1, 1, 1}, 1, 1, 1),
                                     {parts::steel()}, {load_case}),
               InvalidInput);
  // Two supports that move one edge to different places.
  load_case = gradient_parts::held("main");
  load_case.supports.push_back(
      {.surface = "z0", .fix_z = true, .displacement = Vec3(0.0, 0.0, 0.1)});
  expect_refused<InvalidInput>(load_case, "support on 'z0'", "another support");
}

TEST(Pins, ModesOfPartsThatAreFreeRefuseThemByName) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 1.0}, 4, 2, 2);
  EXPECT_THAT([&] { modes::natural_modes(mesh, {parts::steel()}, on_a_pin()); },
              testing::ThrowsMessage<InvalidInput>(
                  AllOf(HasSubstr("'pin'"), HasSubstr("rigid pins"))));
}

TEST(Pins, PetscRefusesThemAndEnforcedDisplacementsByName) {
  const TetMesh mesh = shapes::brick({4.0, 1.0, 1.0}, 4, 2, 2);
  const auto refused = [&](const loads::LoadCase& load_case, const char* what) {
    EXPECT_THAT(
        [&] {
          elastic::ElasticModel(mesh, {parts::steel()}, {load_case},
                                {.solver = equations::SolverKind::Distributed});
        },
        testing::ThrowsMessage<InvalidInput>(
            AllOf(HasSubstr("petsc knows no"), HasSubstr(what),
                  HasSubstr("analysis.solver"))));
  };
  refused(on_a_pin(), "rigid pins");
  refused(stretched(), "enforced displacements");
}

TEST(Pins, MayNotChangeButInNumbers) {
  const TetMesh mesh = gradient_parts::block(1);
  const elastic::ElasticModel model(mesh, gradient_parts::materials(),
                                    {between_pins()});
  loads::LoadCase moved = between_pins();
  moved.pins[0].displacement = Vec3(0.1, 0.2, 0.3);
  moved.pins[0].point.x() += 0.1;
  EXPECT_FALSE(model.solve(mesh, {moved}).failure);
  moved.pins[1].fix = {true, false, true};
  EXPECT_THROW(model.solve(mesh, {moved}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::pins_test
