#include <omp.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/functionals/displacement_functionals.h"
#include "fea/functionals/energy_functionals.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::adjoint_test {
namespace {

using derivatives::expect_derivative;
using derivatives::moved;
using derivatives::wave;
using testing::HasSubstr;

/// Of solutions; differences over steps of 1e-3 make 1e-9 of it.
constexpr double kSolver = 1e-13;
constexpr double kTotal = 3e-8;

struct Problem {
  TetMesh mesh;
  std::vector<element::Material> materials;
  std::vector<loads::LoadCase> load_cases;
};

struct Total {
  double value = 0.0;
  Points gradient;
};

/// A functional of the solution, and its gradient through the solution.
template <class OfMesh>
Total total_gradient(const elastic::ElasticModel& model, const Problem& problem,
                     int load_case, const OfMesh& functional) {
  equations::ElasticState state;
  const equations::ElasticSolution solution =
      model.solve(problem.mesh, problem.load_cases, &state);
  EXPECT_FALSE(solution.failure) << solution.failure->message;
  const VectorX& u = solution.displacements[load_case];
  const element::Functional here = functional(problem.mesh, u);
  const equations::AdjointSolution adjoint =
      model.solve_adjoint(state, load_case, {here.by_displacement});
  EXPECT_FALSE(adjoint.failure) << adjoint.failure->message;
  Total total{here.value, elastic::residual_gradient(
                              problem.mesh, problem.materials,
                              problem.load_cases[load_case],
                              {u, solution.reactions[load_case],
                               adjoint.lambda[0], adjoint.reactions[0]})};
  flat(total.gradient) += flat(here.by_nodes);
  return total;
}

template <class OfMesh>
void expect_total(const Problem& problem, int load_case, const VectorX& dx,
                  const OfMesh& functional) {
  const elastic::ElasticModel model(problem.mesh, problem.materials,
                                    problem.load_cases, {.tolerance = kSolver});
  const Total here = total_gradient(model, problem, load_case, functional);
  expect_derivative(
      {.exact = flat(here.gradient).dot(dx),
       .scale = flat(here.gradient).cwiseProduct(dx).lpNorm<1>(),
       .tolerance = kTotal},
      [&](double t) {
        const TetMesh mesh = moved(problem.mesh, dx, t);
        const equations::ElasticSolution solution =
            model.solve(mesh, problem.load_cases);
        EXPECT_FALSE(solution.failure);
        return functional(mesh, solution.displacements[load_case]).value;
      });
}

element::Functional pad_mean(const TetMesh& mesh, const VectorX& u) {
  return functionals::mean_displacement_functional(mesh, "x1", {0.5, 1.0, -1.0},
                                                   u);
}

class Adjoint : public testing::TestWithParam<int> {};

TEST_P(Adjoint, TotalGradientOfEveryLoad) {
  const Problem problem{gradient_parts::block(GetParam()),
                        gradient_parts::materials(),
                        gradient_parts::load_cases()};
  const VectorX dx = wave(problem.mesh, 0.4);
  for (std::size_t c = 0; c < problem.load_cases.size(); ++c) {
    SCOPED_TRACE(problem.load_cases[c].name);
    expect_total(problem, static_cast<int>(c), dx, pad_mean);
  }
}

TEST_P(Adjoint, ComplianceIsItsOwnAdjoint) {
  const Problem problem{gradient_parts::block(GetParam()),
                        gradient_parts::materials(),
                        gradient_parts::load_cases()};
  const elastic::ElasticModel model(problem.mesh, problem.materials,
                                    problem.load_cases, {.tolerance = kSolver});
  equations::ElasticState state;
  const equations::ElasticSolution solution =
      model.solve(problem.mesh, problem.load_cases, &state);
  const VectorX& u = solution.displacements[0];
  const equations::AdjointSolution adjoint = model.solve_adjoint(
      state, 0,
      {functionals::compliance_functional(problem.mesh, problem.materials,
                                          problem.load_cases[0], u)
           .by_displacement});
  EXPECT_LE((adjoint.lambda[0] - u).norm(), 1e-9 * u.norm());
  EXPECT_LE((adjoint.reactions[0] - solution.reactions[0]).norm(),
            1e-9 * solution.reactions[0].norm());
}

TEST_P(Adjoint, SpringsByAreaAndInTotal) {
  Problem problem{gradient_parts::block(GetParam()),
                  gradient_parts::materials(),
                  {gradient_parts::held("bed")}};
  loads::LoadCase& load_case = problem.load_cases[0];
  load_case.forces = {{"x1", {1.0, 2.0, -3.0}}};
  load_case.springs = {
      {.surface = "z0", .components = {1.0, 2.0, 0.5}, .normal = 4.0},
      {.surface = "y1",
       .components = {0.0, 3.0, 0.0},
       .normal = 2.0,
       .measure = loads::SpringMeasure::Total,
       .axes = element::LocalAxes{{1.0, 0.2, 0.0}, {0.0, 1.0, 0.3}}}};
  expect_total(problem, 0, wave(problem.mesh, 0.4), pad_mean);
}

INSTANTIATE_TEST_SUITE_P(Orders, Adjoint, testing::Values(1, 2));

/// Slides on its bore and outside, where it also rests on springs; the planes
/// fix components.
TEST(Adjoint, SlidingSurfacesTurn) {
  Problem problem{parts::quarter_tube(2, 0.6), {parts::steel()}, {}};
  loads::LoadCase load_case;
  load_case.name = "slide";
  load_case.supports = {{.surface = "x0", .kind = loads::SupportKind::Normal},
                        {"z0", false, false, true}};
  load_case.springs = {
      {.surface = "x0", .components = {10.0, 20.0, 30.0}, .normal = 100.0}};
  load_case.pressures = {{"x1", 20.0}};
  load_case.tractions = {{"y1", {5.0, -3.0, 1.0}}};
  problem.load_cases = {load_case};
  const auto functional = [](const TetMesh& mesh, const VectorX& u) {
    return functionals::mean_displacement_functional(mesh, "y0",
                                                     {0.5, 1.0, -1.0}, u);
  };
  const VectorX dx = 0.2 * wave(problem.mesh, 0.4);
  expect_total(problem, 0, dx, functional);
  const auto energy = [&](const TetMesh& mesh, const VectorX& u) {
    return functionals::strain_energy_functional(mesh, problem.materials,
                                                 load_case, u);
  };
  expect_total(problem, 0, dx, energy);
}

/// Planes of symmetry that turn and shear as wholes, two of them at right
/// angles no longer where they meet.
TEST(Adjoint, PlanesOfSymmetryTurn) {
  Problem problem{parts::quarter_tube(2, 0.6), {parts::steel()}, {}};
  loads::LoadCase load_case = parts::tube_pressure(10.0);
  load_case.supports = {
      {.surface = "y0", .kind = loads::SupportKind::Symmetry},
      {.surface = "y1", .kind = loads::SupportKind::Symmetry},
      {.surface = "z0", .kind = loads::SupportKind::Symmetry}};
  problem.load_cases = {load_case};
  Mat3 affine;
  affine << 0.1, -0.4, 0.2, 0.3, -0.2, 0.5, -0.3, 0.1, 0.2;
  VectorX dx(static_cast<Eigen::Index>(3 * problem.mesh.nodes.size()));
  for (std::size_t i = 0; i < problem.mesh.nodes.size(); ++i) {
    dx.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        affine * problem.mesh.nodes[i];
  }
  expect_total(problem, 0, dx, [](const TetMesh& mesh, const VectorX& u) {
    return functionals::mean_displacement_functional(mesh, "x1",
                                                     {0.5, 1.0, -1.0}, u);
  });
}

TEST(Adjoint, SeveralRightHandSidesAreThoseSolvedAlone) {
  const Problem problem{gradient_parts::block(2),
                        gradient_parts::materials(),
                        {gradient_parts::load_cases()[0]}};
  const elastic::ElasticModel model(problem.mesh, problem.materials,
                                    problem.load_cases);
  equations::ElasticState state;
  model.solve(problem.mesh, problem.load_cases, &state);
  std::vector<VectorX> right;
  for (int k = 0; k < 6; ++k) {
    right.push_back(wave(problem.mesh, 0.7 * k));
  }
  right[4].setZero();
  const equations::AdjointSolution together =
      model.solve_adjoint(state, 0, right);
  ASSERT_FALSE(together.failure) << together.failure->message;
  ASSERT_EQ(together.lambda.size(), right.size());
  EXPECT_TRUE(together.lambda[4].isZero(0.0));
  for (std::size_t k = 0; k < right.size(); ++k) {
    const equations::AdjointSolution alone =
        model.solve_adjoint(state, 0, {right[k]});
    EXPECT_LE((together.lambda[k] - alone.lambda[0]).norm(),
              1e-9 * alone.lambda[0].norm());
  }
}

/// Three load cases held alike and one that is not, mixed: each by its own
/// supports, in its own place.
TEST(Adjoint, SeveralLoadCasesAreThoseSolvedAlone) {
  Problem problem{gradient_parts::block(2), gradient_parts::materials(),
                  gradient_parts::load_cases()};
  problem.load_cases.resize(4);
  problem.load_cases[2].supports = {parts::hold("y0")};
  const elastic::ElasticModel model(problem.mesh, problem.materials,
                                    problem.load_cases);
  equations::ElasticState state;
  model.solve(problem.mesh, problem.load_cases, &state);
  const std::vector<int> cases = {3, 2, 0, 1, 2, 3};
  std::vector<VectorX> right;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    right.push_back(wave(problem.mesh, 0.7 * static_cast<double>(k)));
  }
  const equations::AdjointSolution together =
      model.solve_adjoints(state, cases, right);
  ASSERT_FALSE(together.failure) << together.failure->message;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const equations::AdjointSolution alone =
        model.solve_adjoint(state, cases[k], {right[k]});
    EXPECT_LE((together.lambda[k] - alone.lambda[0]).norm(),
              1e-9 * alone.lambda[0].norm());
    EXPECT_LE((together.reactions[k] - alone.reactions[0]).norm(),
              1e-7 * alone.reactions[0].norm());
  }
  EXPECT_THROW(model.solve_adjoints(state, {0, 1}, right), InvalidInput);
}

/// Both by multigrid, on more nodes than one thread takes at once.
TEST(Adjoint, TheSameBitsOnTwoThreads) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({3.0, 1.0, 1.0}, 20, 8, 8));
  const Problem problem{
      mesh, {parts::steel()}, {parts::pulled({1.0, 2.0, 3.0})}};
  std::vector<Points> gradients;
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    const elastic::ElasticModel model(problem.mesh, problem.materials,
                                      problem.load_cases);
    gradients.push_back(total_gradient(model, problem, 0, pad_mean).gradient);
  }
  omp_set_num_threads(omp_get_num_procs());
  EXPECT_EQ(gradients[0], gradients[1]);
}

TEST(Adjoint, RefusesWhatItCannotDifferentiate) {
  Problem problem{gradient_parts::block(1),
                  gradient_parts::materials(),
                  {gradient_parts::with_fields()}};
  loads::LoadCase& load_case = problem.load_cases[0];
  load_case.pressures[0].slope = {};
  const VectorX v = wave(problem.mesh, 0.1);
  try {
    elastic::force_gradient(problem.mesh, problem.materials, load_case, v);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("load case 'fields': the pressure on "
                                        "surface 'z1' is a field without"));
  }
  const elastic::ElasticModel model(problem.mesh, problem.materials,
                                    problem.load_cases);
  const equations::ElasticState empty;
  EXPECT_THROW(model.solve_adjoint(empty, 0, {v}), InvalidInput);
  equations::ElasticState state;
  model.solve(problem.mesh, problem.load_cases, &state);
  EXPECT_FALSE(state.empty());
  EXPECT_THROW(model.solve_adjoint(state, 1, {v}), InvalidInput);
  EXPECT_THROW(model.solve_adjoint(state, 0, {VectorX(v.head(9))}),
               InvalidInput);
  TetMesh inverted = problem.mesh;
  std::swap(inverted.nodes.front(), inverted.nodes.back());
  EXPECT_TRUE(
      model.solve(inverted, problem.load_cases, &state).failure.has_value());
  EXPECT_TRUE(state.empty());
}

}  // namespace
}  // namespace meniscus::adjoint_test
