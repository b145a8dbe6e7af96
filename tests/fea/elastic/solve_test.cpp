#include <omp.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/solver/row_chunks.h"
#include "tests/support/parts.h"

namespace meniscus::solve_test {
namespace {

constexpr double kSolvers = 1e-8;  // what two solvers may differ by
constexpr double kBalance = 1e-9;  // reactions against loads
constexpr double kPatch = 1e-12;   // rounding only

TetMesh bar(int order, int cells) {
  TetMesh mesh = shapes::brick({3.0, 1.0, 1.0}, 3 * cells, cells, cells);
  return order == 1 ? mesh : shapes::straight_quadratic(mesh);
}

std::vector<loads::LoadCase> two_cases() {
  loads::LoadCase twist = parts::pulled({0.0, 20.0, 5.0});
  twist.name = "second";
  twist.pressures = {{"z1", 3.0}};
  return {parts::pulled({1.0, 0.0, -10.0}), twist};
}

double difference(const VectorX& a, const VectorX& b) {
  return (a - b).lpNorm<Eigen::Infinity>() / b.lpNorm<Eigen::Infinity>();
}

class Solve : public testing::TestWithParam<int> {};

TEST_P(Solve, PulledDistortedBlockStretchesLinearly) {
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 3);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  loads::LoadCase pull;
  pull.name = "pull";
  pull.supports = {{"x0", true, false, false},
                   {"y0", false, true, false},
                   {"z0", false, false, true}};
  pull.forces = {{"x1", {3.0, 0.0, 0.0}}};  // unit stress on 2 x 1.5
  const elastic::ElasticModel model(mesh, {parts::steel()}, {pull},
                                    {.tolerance = 1e-14});
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  const double E = parts::steel().youngs_modulus;
  const double nu = parts::steel().poisson_ratio;
  VectorX exact(solution.displacements[0].size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    exact.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        Vec3(x.x(), -nu * x.y(), -nu * x.z()) / E;
  }
  EXPECT_LE(difference(solution.displacements[0], exact), kPatch);
}

TEST_P(Solve, ReactionsBalanceAndEnergyIsHalfTheWorkOfTheLoads) {
  const TetMesh mesh = bar(GetParam(), 3);
  const std::vector<loads::LoadCase> cases = two_cases();
  const elastic::ElasticModel model(mesh, {parts::steel()}, cases);
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  EXPECT_LE(solution.report.reaction_imbalance, kBalance);
  // The solver stops at 1e-10 in the energy norm, which weighs short waves
  // less.
  EXPECT_LE(solution.report.residual, 1e-8);
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const VectorX f = loads::nodal_forces(mesh, cases[c]);
    Vec3 force = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      const Vec3 sum = f.segment<3>(at) + solution.reactions[c].segment<3>(at);
      force += sum;
      moment += mesh.nodes[i].cross(sum);
    }
    EXPECT_LE(force.norm(), kBalance * f.norm());
    EXPECT_LE(moment.norm(), kBalance * 3.0 * f.norm());
  }
  const double work =
      0.5 * loads::nodal_forces(mesh, cases[0]).dot(solution.displacements[0]);
  EXPECT_NEAR(solution.report.strain_energy, work, 1e-9 * work);
}

TEST_P(Solve, SameBitsForThereAndBackAndForAnyThreadCount) {
  const TetMesh base = bar(GetParam(), 3);
  const TetMesh moved = shapes::sheared(base, 0.05);
  const auto kind = GetParam() == 2 ? equations::SolverKind::Multigrid
                                    : equations::SolverKind::Automatic;
  const auto run = [&](int threads) {
    omp_set_num_threads(threads);
    const elastic::ElasticModel model(base, {parts::steel()}, two_cases(),
                                      {.solver = kind});
    equations::ElasticSolution first = model.solve(moved);
    const equations::ElasticSolution between = model.solve(base);
    const equations::ElasticSolution again = model.solve(moved);
    EXPECT_FALSE(first.failure);
    for (int c = 0; c < 2; ++c) {
      EXPECT_EQ(first.displacements[c], again.displacements[c]);
      EXPECT_EQ(first.reactions[c], again.reactions[c]);
      EXPECT_EQ(between.displacements[c],
                model.base_solution().displacements[c]);
    }
    return first;
  };
  const int before = omp_get_max_threads();
  const equations::ElasticSolution one = run(1);
  const equations::ElasticSolution two = run(2);
  omp_set_num_threads(before);
  EXPECT_EQ(one.displacements[0], two.displacements[0]);
  EXPECT_EQ(one.displacements[1], two.displacements[1]);
  EXPECT_EQ(one.reactions[1], two.reactions[1]);
}

// Large enough that products, sweeps and coarse levels are shared by threads.
TEST_P(Solve, SameBitsWhereThreadsShareTheWork) {
  const TetMesh linear = shapes::brick({1.5, 1.0, 1.0}, 28, 20, 20);
  const TetMesh base = GetParam() == 1
                           ? linear
                           : shapes::straight_quadratic(
                                 shapes::brick({1.5, 1.0, 1.0}, 18, 13, 13));
  ASSERT_GT(static_cast<int>(base.nodes.size()), solver::kParallelRows);
  const TetMesh moved = shapes::sheared(base, 0.05);
  const auto run = [&](int threads) {
    omp_set_num_threads(threads);
    const elastic::ElasticModel model(base, {parts::steel()}, two_cases());
    equations::ElasticSolution solution = model.solve(moved);
    EXPECT_FALSE(solution.failure);
    stress::StressField stress = stress::recover_stress(
        moved, {parts::steel()}, solution.displacements[0]);
    return std::pair(std::move(solution), std::move(stress));
  };
  const int before = omp_get_max_threads();
  const auto one = run(1);
  const auto two = run(2);
  omp_set_num_threads(before);
  for (int c = 0; c < 2; ++c) {
    EXPECT_EQ(one.first.displacements[c], two.first.displacements[c]);
    EXPECT_EQ(one.first.reactions[c], two.first.reactions[c]);
  }
  EXPECT_EQ(one.second.von_mises, two.second.von_mises);
}

TEST_P(Solve, NextDesignEqualsAFreshModelOfIt) {
  const TetMesh base = bar(GetParam(), 3);
  const TetMesh moved = shapes::sheared(base, 0.1);
  std::vector<loads::LoadCase> cases = two_cases();
  const elastic::ElasticModel model(base, {parts::steel()}, cases);
  cases[0].forces[0].total *= 2.0;
  const equations::ElasticSolution next = model.solve(moved, cases);
  const elastic::ElasticModel fresh(moved, {parts::steel()}, cases);
  ASSERT_FALSE(next.failure) << next.failure->message;
  for (int c = 0; c < 2; ++c) {
    EXPECT_LE(difference(next.displacements[c],
                         fresh.base_solution().displacements[c]),
              kSolvers);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, Solve, testing::Values(1, 2));

TEST(Multigrid, AgreesWithCholeskyOnStraightAndCurvedParts) {
  struct Model {
    TetMesh mesh;
    loads::LoadCase load_case;
  };
  for (const Model& part :
       {Model{bar(2, 4), two_cases()[1]},
        Model{shapes::sheared(bar(2, 3), 0.5), two_cases()[0]},
        Model{parts::distorted_brick({2.0, 1.0, 1.0}, 7), two_cases()[1]},
        Model{parts::quarter_tube(4, 0.5), parts::tube_pressure(2.0)}}) {
    const elastic::ElasticModel multigrid(
        part.mesh, {parts::steel()}, {part.load_case},
        {.solver = equations::SolverKind::Multigrid});
    const elastic::ElasticModel cholesky(
        part.mesh, {parts::steel()}, {part.load_case},
        {.solver = equations::SolverKind::Cholesky});
    const equations::ElasticSolution& a = multigrid.base_solution();
    const equations::ElasticSolution& b = cholesky.base_solution();
    ASSERT_FALSE(a.failure) << a.failure->message;
    ASSERT_FALSE(b.failure) << b.failure->message;
    EXPECT_EQ(a.report.solver,
              part.mesh.order == 2 ? "p-multigrid" : "multigrid");
    EXPECT_EQ(b.report.solver, "cholmod");
    EXPECT_LE(difference(a.displacements[0], b.displacements[0]), kSolvers);
    EXPECT_LE(a.report.iterations, 40);
    EXPECT_LE(b.report.iterations, 3);
  }
}

TEST(Multigrid, HoldsForThinWallsNearlyIncompressibleAndMixedMaterials) {
  const TetMesh wall =
      shapes::straight_quadratic(shapes::brick({20.0, 20.0, 1.0}, 12, 12, 1));
  TetMesh mixed = bar(2, 3);
  for (int e = 0; e < mixed.element_count(); e += 2) {
    mixed.element_region[e] = 1;
  }
  element::Material rubber = parts::steel();
  rubber.poisson_ratio = 0.49;
  element::Material soft = parts::steel();
  soft.youngs_modulus /= 100.0;
  struct Model {
    const TetMesh& mesh;
    std::vector<element::Material> materials;
  };
  const TetMesh plain = bar(2, 3);
  for (const Model& part :
       {Model{wall, {parts::steel()}}, Model{plain, {rubber}},
        Model{mixed, {parts::steel(), soft}}}) {
    const elastic::ElasticModel model(
        part.mesh, part.materials, two_cases(),
        {.solver = equations::SolverKind::Multigrid});
    ASSERT_FALSE(model.base_solution().failure)
        << model.base_solution().failure->message;
    EXPECT_LE(model.base_solution().report.iterations, 200);
  }
}

TEST(Multigrid, AFactorTakesOverWhereWallsAreThinAndChange) {
  const TetMesh wall =
      shapes::straight_quadratic(shapes::brick({40.0, 40.0, 0.8}, 14, 14, 1));
  TetMesh thin = wall;
  for (Vec3& x : thin.nodes) {
    x.z() *= 0.3 + 0.4 * x.x() / 40.0;
  }
  const elastic::ElasticModel slow(
      wall, {parts::steel()}, two_cases(),
      {.solver = equations::SolverKind::Multigrid});
  const elastic::ElasticModel model(wall, {parts::steel()}, two_cases(), {});
  const elastic::ElasticModel own(thin, {parts::steel()}, two_cases(), {});
  ASSERT_GT(slow.base_solution().report.iterations, 60);
  EXPECT_EQ(model.base_solution().report.solver, "cholmod");
  equations::ElasticState state;
  const equations::ElasticSolution found =
      model.solve(thin, two_cases(), &state);
  ASSERT_FALSE(found.failure) << found.failure->message;
  ASSERT_FALSE(own.base_solution().failure);
  EXPECT_LE(found.report.iterations, 30);
  EXPECT_LE(
      difference(found.displacements[1], own.base_solution().displacements[1]),
      kSolvers);
  const equations::AdjointSolution adjoint = model.solve_adjoint(
      state, 1, {loads::nodal_forces(thin, two_cases()[1], {parts::steel()})});
  ASSERT_FALSE(adjoint.failure) << adjoint.failure->message;
  EXPECT_LE(difference(adjoint.lambda[0], found.displacements[1]), kSolvers);
}

TEST(Multigrid, OtherMaterialsThanTheBasesAreSolvedByItsPreconditioner) {
  TetMesh mesh = bar(2, 3);
  for (int e = 0; e < mesh.element_count(); e += 2) {
    mesh.element_region[e] = 1;
  }
  element::Material heavy = parts::steel();
  heavy.density *= 2.0;
  element::Material soft = parts::steel();
  soft.youngs_modulus /= 3.0;
  loads::LoadCase weight = parts::pulled({0.0, 0.0, -1.0});
  weight.gravity = {0.0, 1e6, 0.0};
  const elastic::ElasticModel base(
      mesh, {parts::steel(), parts::steel()}, {weight},
      {.solver = equations::SolverKind::Multigrid});
  const elastic::ElasticModel own(mesh, {heavy, soft}, {weight},
                                  {.solver = equations::SolverKind::Multigrid});
  equations::ElasticState state;
  const equations::ElasticSolution other =
      base.solve(mesh, {weight}, {heavy, soft}, &state);
  ASSERT_FALSE(other.failure) << other.failure->message;
  const VectorX& u = own.base_solution().displacements[0];
  EXPECT_LE(difference(other.displacements[0], u), kSolvers);
  // The adjoint is of the same stiffness.
  const equations::AdjointSolution adjoint = base.solve_adjoint(
      state, 0, {loads::nodal_forces(mesh, weight, {heavy, soft})});
  ASSERT_FALSE(adjoint.failure) << adjoint.failure->message;
  EXPECT_LE(difference(adjoint.lambda[0], u), kSolvers);
  EXPECT_THROW(base.solve(mesh, {weight}, {soft}, nullptr), InvalidInput);
}

TEST(Multigrid, SmallScalesAndLargeOnesGiveTheSameShape) {
  const TetMesh mesh = bar(2, 2);
  const auto solve = [&](double length, double force) {
    TetMesh scaled = mesh;
    for (Vec3& x : scaled.nodes) {
      x *= length;
    }
    element::Material material = parts::steel();
    material.youngs_modulus *= force / (length * length);
    loads::LoadCase load_case = parts::pulled(force * Vec3(0.0, 0.0, -1.0));
    const elastic::ElasticModel model(
        scaled, {material}, {load_case},
        {.solver = equations::SolverKind::Multigrid});
    EXPECT_FALSE(model.base_solution().failure);
    return VectorX(model.base_solution().displacements[0] / length);
  };
  const VectorX unit = solve(1.0, 1.0);
  EXPECT_LE(difference(solve(1e-9, 1e-20), unit), kSolvers);
  EXPECT_LE(difference(solve(1e9, 1e25), unit), kSolvers);
}

TEST(LoadCases, WithOtherSupportsAndMoreThanFourAreSolvedAsAlone) {
  const TetMesh mesh = bar(2, 2);
  std::vector<loads::LoadCase> cases;
  for (int c = 0; c < 6; ++c) {
    loads::LoadCase load_case =
        parts::pulled(Vec3(1.0, 0.5 * c, 2.0 - static_cast<double>(c)));
    load_case.name = "case " + std::to_string(c);
    if (c == 3) {
      load_case.supports = {parts::hold("y0")};
    }
    cases.push_back(load_case);
  }
  for (const equations::SolverKind kind :
       {equations::SolverKind::Cholesky, equations::SolverKind::Multigrid}) {
    const elastic::ElasticModel together(mesh, {parts::steel()}, cases,
                                         {.solver = kind});
    ASSERT_FALSE(together.base_solution().failure);
    for (int c = 0; c < 6; ++c) {
      const elastic::ElasticModel alone(mesh, {parts::steel()}, {cases[c]},
                                        {.solver = kind});
      EXPECT_LE(difference(together.base_solution().displacements[c],
                           alone.base_solution().displacements[0]),
                kSolvers);
    }
  }
}

}  // namespace
}  // namespace meniscus::solve_test
