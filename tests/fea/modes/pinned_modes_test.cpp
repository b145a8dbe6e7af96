/// Rigid pins in modes and buckling: elimination by hand, closed forms, exact
/// derivatives.
#include <numbers>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "fea/element/elastic_law.h"
#include "fea/modes/buckling.h"
#include "fea/modes/eigenvalue_functionals.h"
#include "fea/modes/modes.h"
#include "tests/support/coupled_freedom.h"
#include "tests/support/derivatives.h"
#include "tests/support/eigen_parts.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::pinned_modes_test {
namespace {

using derivatives::expect_derivative;
using std::numbers::pi;

/// Against a dense solver: values err by the square of a mode's residual.
constexpr double kByHand = 1e-9;

/// Held at one end, loaded and stiffened by a free pin at the other.
loads::LoadCase on_a_pin() {
  loads::LoadCase load_case = gradient_parts::held("pin");
  load_case.pins = {{.surfaces = "x1"}};
  load_case.remote_loads = {{.surfaces = "x1",
                             .point = {1.4, 0.7, -0.4},
                             .force = {-5.0, -1.0, 2.0},
                             .moment = {0.4, 0.3, -0.6}}};
  return load_case;
}

/// Two pins alone, which hold some motions.
loads::LoadCase between_pins() {
  loads::LoadCase load_case{.name = "two pins"};
  load_case.pins = {{.surfaces = "x0",
                     .fix = {true, true, true},
                     .fix_rotation = {true, false, true},
                     .point = {-0.3, 0.5, 0.4}},
                    {.surfaces = "x1",
                     .fix = {false, false, true},
                     .point = {1.8, 0.2, 0.1}}};
  load_case.remote_loads = {{.surfaces = "x1",
                             .point = {2.0, 0.4, 0.3},
                             .force = {-4.0, -1.0, 0.0},
                             .moment = {0.4, 0.3, -0.6}}};
  return load_case;
}

struct Part {
  TetMesh mesh;
  std::vector<element::Material> materials;
  std::vector<loads::LoadCase> cases;
  equations::SolverKind solver = equations::SolverKind::Automatic;

  elastic::ElasticModel model() const {
    return {mesh, materials, cases, {.solver = solver, .tolerance = 1e-12}};
  }
  modes::NaturalModes vibration(int count) const {
    return modes::natural_modes(model(), mesh, cases, 0,
                                {.count = count, .tolerance = 1e-9});
  }
  modes::BucklingModes buckling(int count) const {
    const elastic::ElasticModel solved = model();
    return modes::buckling_modes(
        solved, mesh, cases, 0, solved.base_solution().displacements[0],
        {.count = count, .tolerance = 1e-9, .largest = 1e9});
  }
};

/// E^T A E of what stays rigid.
template <class Matrix>
Eigen::MatrixXd coupled(const solver::ElementTable& table, const Matrix& A,
                        const Eigen::MatrixXd& E) {
  Eigen::MatrixXd AE(E.rows(), E.cols());
  for (Eigen::Index k = 0; k < E.cols(); ++k) {
    AE.col(k) = parts::product(table, A, E.col(k));
  }
  return E.transpose() * AE;
}

class PinnedModes : public testing::TestWithParam<int> {};

TEST_P(PinnedModes, AreTheCouplingEliminatedByHand) {
  for (const loads::LoadCase& load_case : {on_a_pin(), between_pins()}) {
    Part part{gradient_parts::block(GetParam(), 2),
              gradient_parts::materials(),
              {load_case}};
    const solver::ElementTable table = parts::table_of(part.mesh);
    solver::BlockMatrix<double> K;
    ASSERT_FALSE(solver::assemble(table, part.mesh.nodes,
                                  element::elastic_laws(part.materials), K));
    const Eigen::MatrixXd E =
        parts::coupled_freedom(part.mesh, load_case).columns;
    const solver::NodalMatrix M = solver::mass_matrix(
        table, part.mesh.nodes,
        {part.materials[0].density, part.materials[1].density});
    const elastic::ElasticModel model = part.model();
    const solver::NodalMatrix G = solver::geometric_stiffness(
        table, part.mesh.nodes, parts::own_elements(part.mesh),
        element::point_stress(part.mesh, part.materials,
                              model.base_solution().displacements[0]));
    const Eigen::MatrixXd k = coupled(table, K, E);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> vibration(
        coupled(table, M, E), k, Eigen::EigenvaluesOnly);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> buckling(
        -coupled(table, G, E), k, Eigen::EigenvaluesOnly);
    for (const auto kind :
         {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
      part.solver = kind;
      const modes::NaturalModes found = part.vibration(3);
      ASSERT_FALSE(found.failure) << found.failure->message;
      const modes::BucklingModes factors = part.buckling(2);
      ASSERT_FALSE(factors.failure) << factors.failure->message;
      for (std::size_t j = 0; j < 3; ++j) {
        const double theta =
            vibration.eigenvalues().reverse()[static_cast<Eigen::Index>(j)];
        const double exact = 1.0 / (2.0 * pi * std::sqrt(theta));
        EXPECT_NEAR(found.frequencies[j], exact, kByHand * exact) << j;
      }
      for (std::size_t j = 0; j < 2; ++j) {
        const double exact =
            1.0 /
            buckling.eigenvalues().reverse()[static_cast<Eigen::Index>(j)];
        EXPECT_NEAR(factors.factors[j], exact, kByHand * exact) << j;
      }
    }
  }
}

/// By places and by the points of pins that hold.
TEST_P(PinnedModes, HaveExactDerivatives) {
  const VectorX turn = Eigen::Vector3d(0.3, -0.2, 0.5);
  for (const loads::LoadCase& load_case : {on_a_pin(), between_pins()}) {
    const Part part{gradient_parts::block(GetParam(), 2),
                    gradient_parts::materials(),
                    {load_case}};
    const VectorX dx = derivatives::wave(part.mesh, 0.4);
    const modes::NaturalModes found = part.vibration(3);
    for (std::size_t k = 0; k < 2; ++k) {
      const modes::ModeFunctional by = modes::frequency_functional(
          part.mesh, part.materials, part.cases[0],
          {found.frequencies, found.shapes,
           VectorX::Unit(3, static_cast<Eigen::Index>(k))});
      const VectorX by_nodes = flat(by.by_nodes);
      double by_points = 0.0;
      for (std::size_t p = 0; p < load_case.pins.size(); ++p) {
        by_points += by.by_pin_point[p].dot(turn);
      }
      expect_derivative({.exact = by_nodes.dot(dx) + by_points,
                         .scale = by_nodes.cwiseProduct(dx).lpNorm<1>(),
                         .tolerance = 1e-6},
                        [&](double t) {
                          Part there = part;
                          there.mesh = derivatives::moved(part.mesh, dx, t);
                          for (loads::RigidPin& pin : there.cases[0].pins) {
                            pin.point += t * turn;
                          }
                          return there.vibration(3).frequencies[k];
                        });
    }
    // Of factors at held displacement: K_g is that of u.
    const elastic::ElasticModel model = part.model();
    const VectorX u = model.base_solution().displacements[0];
    const modes::BucklingModes factors = part.buckling(2);
    const modes::ModeFunctional by = modes::factor_functional(
        part.mesh, part.materials, part.cases[0], u,
        {factors.factors, factors.shapes, VectorX::Unit(2, 0)});
    const VectorX by_nodes = flat(by.by_nodes);
    expect_derivative(
        {.exact = by_nodes.dot(dx),
         .scale = by_nodes.cwiseProduct(dx).lpNorm<1>(),
         .tolerance = 1e-6},
        [&](double t) {
          const TetMesh there = derivatives::moved(part.mesh, dx, t);
          return modes::buckling_modes(
                     model, there, part.cases, 0, u,
                     {.count = 2, .tolerance = 1e-9, .largest = 1e9})
              .factors[0];
        });
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, PinnedModes, testing::Values(1, 2));

/// A slender bar with a rigid plate at its far end or at both.
Part bar(const loads::LoadCase& load_case) {
  return {shapes::straight_quadratic(shapes::brick({40.0, 1.0, 1.2}, 20, 1, 1)),
          {{"bar", 1000.0, 0.0, 1.0, {}}},
          {load_case},
          equations::SolverKind::Cholesky};
}

/// Of bending about y and about z, the weaker: 1 high, 1.2 wide.
constexpr double kLength = 40.0;
constexpr double kInertia = 1.2 / 12.0;
constexpr double kArea = 1.2;
constexpr double kModulus = 1000.0;
/// Beams without shear, which the bar has: 0.1 %; elements: as much.
constexpr double kBeam = 2e-3;

double euler(double effective_length) {
  return pi * pi * kModulus * kInertia / std::pow(effective_length, 2);
}

double beam_frequency(double beta_length) {
  return std::pow(beta_length / kLength, 2) *
         std::sqrt(kModulus * kInertia / kArea) / (2.0 * pi);
}

loads::RemoteLoad push() {
  return {.surfaces = "x1", .point = {40.0, 0.5, 0.6}, .force = {-1.0, 0, 0}};
}

void expect_beam(const loads::LoadCase& load_case, double factor,
                 double frequency) {
  const Part part = bar(load_case);
  const modes::BucklingModes factors = part.buckling(1);
  ASSERT_FALSE(factors.failure) << factors.failure->message;
  EXPECT_NEAR(factors.factors[0], factor, kBeam * factor);
  const modes::NaturalModes found = part.vibration(1);
  ASSERT_FALSE(found.failure) << found.failure->message;
  EXPECT_NEAR(found.frequencies[0], frequency, kBeam * frequency);
}

// Plates that turn about the middles of the ends.
TEST(PinnedModesOf, ABarBetweenHingesAreEulers) {
  loads::LoadCase load_case{.name = "hinges"};
  load_case.pins = {{.surfaces = "x0",
                     .fix = {true, true, true},
                     .fix_rotation = {true, false, false},
                     .point = {0.0, 0.5, 0.6}},
                    {.surfaces = "x1",
                     .fix = {false, true, true},
                     .point = {40.0, 0.5, 0.6}}};
  load_case.remote_loads = {push()};
  expect_beam(load_case, euler(kLength), beam_frequency(pi));
}

// A plate that may move and not turn.
TEST(PinnedModesOf, AGuidedBarAreThoseOfABeam) {
  loads::LoadCase load_case{.name = "guided"};
  load_case.supports = {parts::hold("x0")};
  load_case.pins = {{.surfaces = "x1",
                     .fix_rotation = {true, true, true},
                     .point = {40.0, 0.5, 0.6}}};
  load_case.remote_loads = {push()};
  expect_beam(load_case, euler(kLength), beam_frequency(2.3650203724));
}

// A plate that may do both changes nothing of a cantilever.
TEST(PinnedModesOf, ACantileverWithAPlateAreItsOwn) {
  loads::LoadCase load_case{.name = "free"};
  load_case.supports = {parts::hold("x0")};
  load_case.pins = {{.surfaces = "x1"}};
  load_case.remote_loads = {push()};
  expect_beam(load_case, euler(2.0 * kLength), beam_frequency(1.8751040687));
}

}  // namespace
}  // namespace meniscus::pinned_modes_test
