/// Natural frequencies: what the answer must satisfy.
#include "fea/modes/modes.h"

#include <numbers>
#include <omp.h>

#include <Spectra/MatOp/SparseCholesky.h>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsSolver.h>
#include <gtest/gtest.h>

#include "fea/element/elastic_law.h"
#include "tests/support/eigen_parts.h"

namespace meniscus::modes_test {
namespace {

using std::numbers::pi;

loads::LoadCase held_at_x0() {
  loads::LoadCase load_case;
  load_case.name = "held";
  load_case.supports = {parts::hold("x0")};
  return load_case;
}

TetMesh bar(int order) {
  const TetMesh mesh = shapes::brick({5.0, 1.3, 0.8}, 6, 2, 2);
  return order == 1 ? mesh : shapes::straight_quadratic(mesh);
}

struct Matrices {
  Eigen::SparseMatrix<double> K, M;
};

Matrices matrices_of(const TetMesh& mesh, const element::Material& material,
                     const std::vector<char>& held) {
  const solver::ElementTable table = parts::table_of(mesh);
  solver::BlockMatrix<double> K;
  EXPECT_FALSE(solver::assemble(table, mesh.nodes,
                                element::elastic_laws({material}), K));
  return {parts::sparse(table, K, held),
          parts::sparse(
              table, solver::mass_matrix(table, mesh.nodes, {material.density}),
              held)};
}

class Modes : public testing::TestWithParam<int> {};

// The residual of the answer in the mesh's own numbering, and the scales.
TEST_P(Modes, SolveTheEigenproblemWithUnitMass) {
  const TetMesh mesh = bar(GetParam());
  const element::Material steel = parts::steel();
  const modes::NaturalModes modes =
      modes::natural_modes(mesh, {steel}, held_at_x0(), {.count = 5});
  ASSERT_FALSE(modes.failure) << modes.failure->message;
  ASSERT_EQ(modes.frequencies.size(), 5U);
  EXPECT_EQ(modes.rigid_motions, 0);
  const Matrices m = matrices_of(mesh, steel, {});
  for (std::size_t k = 0; k < 5; ++k) {
    const VectorX& x = modes.shapes[k];
    const double square = std::pow(2.0 * pi * modes.frequencies[k], 2);
    EXPECT_NEAR(x.dot(m.K * x), square, 1e-9 * square);
    EXPECT_NEAR(x.dot(m.M * x), 1.0, 1e-9);
    for (std::size_t j = 0; j < k; ++j) {
      EXPECT_NEAR(x.dot(m.M * modes.shapes[j]), 0.0, 1e-5);
    }
    VectorX r = m.K * x - square * (m.M * x);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      if (mesh.nodes[i].x() < 1e-9) {
        EXPECT_EQ(x.segment<3>(static_cast<Eigen::Index>(3 * i)).norm(), 0.0);
        r.segment<3>(static_cast<Eigen::Index>(3 * i)).setZero();
      }
    }
    EXPECT_LE(r.norm(), 1e-4 * square * (m.M * x).norm());
    EXPECT_LE(modes.residuals[k], 1e-6);
  }
}

// Spectra's Lanczos on K^-1 M, with its own Cholesky factor.
TEST_P(Modes, AreThoseOfSpectra) {
  const TetMesh mesh = bar(GetParam());
  const element::Material steel = parts::steel();
  const int count = 6;
  const modes::NaturalModes modes =
      modes::natural_modes(mesh, {steel}, held_at_x0(), {.count = count});
  const Matrices m = matrices_of(
      mesh, steel, parts::held_unknowns(mesh, [](const Vec3& x, int) {
        return x.x() < 1e-9;
      }));
  Spectra::SparseSymMatProd<double> M(m.M);
  Spectra::SparseCholesky<double> K(m.K);
  Spectra::SymGEigsSolver<decltype(M), decltype(K),
                          Spectra::GEigsMode::Cholesky>
      lanczos(M, K, count, 4 * count);
  lanczos.init();
  ASSERT_EQ(lanczos.compute(Spectra::SortRule::LargestAlge, 1000, 1e-12),
            count);
  ASSERT_EQ(modes.frequencies.size(), static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double theirs =
        1.0 / (2.0 * pi * std::sqrt(lanczos.eigenvalues()[k]));
    EXPECT_NEAR(modes.frequencies[k] / theirs, 1.0, 1e-9) << k;
  }
}

TEST_P(Modes, OfAModelAreThoseOfTheMesh) {
  const TetMesh mesh = bar(GetParam());
  const std::vector<loads::LoadCase> cases = {parts::pulled({1.0, 2.0, 3.0})};
  const elastic::ElasticModel model(mesh, {parts::steel()}, cases);
  const modes::NaturalModes a = modes::natural_modes(model, mesh, cases, 0);
  const modes::NaturalModes b =
      modes::natural_modes(mesh, {parts::steel()}, held_at_x0());
  ASSERT_EQ(a.frequencies.size(), b.frequencies.size());
  for (std::size_t k = 0; k < a.frequencies.size(); ++k) {
    EXPECT_NEAR(a.frequencies[k], b.frequencies[k], 1e-9 * b.frequencies[k]);
    EXPECT_LE((a.shapes[k] - b.shapes[k]).lpNorm<Eigen::Infinity>(),
              1e-4 * b.shapes[k].lpNorm<Eigen::Infinity>());
  }
}

TEST_P(Modes, OfAFreePartLeaveSixRigidMotions) {
  const TetMesh mesh = bar(GetParam());
  const modes::NaturalModes free = modes::natural_modes(
      mesh, {parts::steel()}, loads::LoadCase{.name = "free"});
  ASSERT_FALSE(free.failure) << free.failure->message;
  EXPECT_EQ(free.rigid_motions, 6);
  ASSERT_EQ(free.frequencies.size(), 6U);
  const Matrices m = matrices_of(mesh, parts::steel(), {});
  for (std::size_t k = 0; k < 6; ++k) {
    const VectorX& x = free.shapes[k];
    const double square = std::pow(2.0 * pi * free.frequencies[k], 2);
    EXPECT_NEAR(x.dot(m.K * x), square, 1e-8 * square);
    EXPECT_LE((m.K * x - square * (m.M * x)).norm(),
              1e-4 * square * (m.M * x).norm());
  }
}

TEST_P(Modes, OfASlidingPartLeaveItsThreeMotions) {
  loads::LoadCase sliding;
  sliding.supports = {{.surface = "z0", .fix_z = true}};
  const modes::NaturalModes modes = modes::natural_modes(
      bar(GetParam()), {parts::steel()}, sliding, {.count = 3});
  EXPECT_EQ(modes.rigid_motions, 3);
  EXPECT_EQ(modes.frequencies.size(), 3U);
}

// A stiff part on springs: omega^2 = k / m.
TEST_P(Modes, OfAStiffPartOnSpringsAreThoseOfAMassOnSprings) {
  const TetMesh mesh = bar(GetParam());
  loads::LoadCase sprung;
  sprung.supports = {{.surface = "z0", .fix_y = true},
                     {.surface = "z0", .fix_z = true}};
  sprung.springs = {{.surface = "x0",
                     .components = {50.0, 0.0, 0.0},
                     .measure = loads::SpringMeasure::Total}};
  element::Material stiff = parts::steel();
  stiff.youngs_modulus = 1e7;
  const modes::NaturalModes modes =
      modes::natural_modes(mesh, {stiff}, sprung, {.count = 1});
  ASSERT_FALSE(modes.failure) << modes.failure->message;
  const double mass = stiff.density * 5.0 * 1.3 * 0.8;
  EXPECT_NEAR(modes.frequencies[0], std::sqrt(50.0 / mass) / (2.0 * pi),
              1e-4 * modes.frequencies[0]);
}

INSTANTIATE_TEST_SUITE_P(Orders, Modes, testing::Values(1, 2));

TEST(ModesOf, AFewElementsEndWithTheirLastUnknown) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  const modes::NaturalModes modes =
      modes::natural_modes(mesh, {parts::steel()}, held_at_x0(), {.count = 40});
  EXPECT_FALSE(modes.failure);
  EXPECT_EQ(modes.frequencies.size(), 12U);  // four free nodes
}

TEST(ModesOf, TwoFreePartsLeaveTwelveMotions) {
  TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 2, 2, 2);
  const TetMesh other = mesh;
  const int nodes = static_cast<int>(mesh.nodes.size());
  for (const Vec3& x : other.nodes) {
    mesh.nodes.push_back(x + Vec3(3.0, 0.0, 0.0));
  }
  for (const int node : other.elements) {
    mesh.elements.push_back(node + nodes);
  }
  mesh.element_region.resize(2 * other.element_region.size(), 0);
  mesh.corner_count = 2 * nodes;
  const modes::NaturalModes modes = modes::natural_modes(
      mesh, {parts::steel()}, loads::LoadCase{.name = "free"}, {.count = 2});
  EXPECT_FALSE(modes.failure);
  EXPECT_EQ(modes.rigid_motions, 12);
  ASSERT_EQ(modes.frequencies.size(), 2U);
  EXPECT_NEAR(modes.frequencies[0], modes.frequencies[1],
              1e-9 * modes.frequencies[0]);
}

TEST(ModesOf, WrongInputIsRefused) {
  const TetMesh mesh = bar(1);
  element::Material weightless = parts::steel();
  weightless.density = 0.0;
  EXPECT_THROW(modes::natural_modes(mesh, {weightless}, held_at_x0()),
               InvalidInput);
  EXPECT_THROW(modes::natural_modes(mesh, {weightless}, loads::LoadCase{}),
               InvalidInput);
  EXPECT_THROW(
      modes::natural_modes(mesh, {parts::steel()}, held_at_x0(), {.count = 0}),
      InvalidInput);
  EXPECT_THROW(modes::natural_modes(mesh, {parts::steel()}, held_at_x0(),
                                    {.tolerance = 0.0}),
               InvalidInput);
  loads::LoadCase unknown;
  unknown.supports = {parts::hold("nowhere")};
  EXPECT_THROW(modes::natural_modes(mesh, {parts::steel()}, unknown),
               InvalidInput);
}

TEST(ModesOf, TooFewIterationsAreTold) {
  const modes::NaturalModes modes = modes::natural_modes(
      shapes::straight_quadratic(shapes::brick({40.0, 1.0, 0.5}, 60, 3, 2)),
      {parts::steel()}, held_at_x0(), {.max_iterations = 2});
  ASSERT_TRUE(modes.failure);
  EXPECT_EQ(modes.failure->kind, FailureKind::SolverFailed);
}

// Multigrid in single precision is lost on springs this soft.
TEST(ModesOf, APartThatIsHardlyHeldAreFound) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 2.0, 1.5}, 12, 6, 5));
  const element::Material steel = parts::steel();
  for (const double softness : {1e-3, 1e-6, 1e-9}) {
    const double k = softness * steel.youngs_modulus;
    loads::LoadCase sprung;
    sprung.springs = {{.surface = "x0",
                       .components = {k, k, k},
                       .measure = loads::SpringMeasure::Total}};
    const modes::NaturalModes modes =
        modes::natural_modes(mesh, {steel}, sprung, {.count = 6});
    ASSERT_FALSE(modes.failure) << modes.failure->message;
    EXPECT_EQ(modes.rigid_motions, 0);
    double nearest = 1.0;  // one goes along x, all others turn too
    for (const double f : modes.frequencies) {
      const double up = std::sqrt(k / (steel.density * 12.0)) / (2.0 * pi);
      nearest = std::min(nearest, std::abs(f / up - 1.0));
    }
    EXPECT_LT(nearest, 1e-3) << softness;
  }
}

// More rows than one thread's share: multigrid, products and sums in parallel.
TEST(ModesOf, OneAndTwoThreadsGiveTheSameBits) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({3.0, 2.0, 1.5}, 14, 10, 9));
  const auto run = [&](int threads, const loads::LoadCase& held) {
    omp_set_num_threads(threads);
    return modes::natural_modes(mesh, {parts::steel()}, held,
                                {.count = 1, .tolerance = 1e-3});
  };
  const int before = omp_get_max_threads();
  for (const loads::LoadCase& held :
       {held_at_x0(), loads::LoadCase{.name = "free"}}) {
    const modes::NaturalModes one = run(1, held);
    const modes::NaturalModes two = run(2, held);
    EXPECT_FALSE(one.failure);
    EXPECT_EQ(one.frequencies, two.frequencies);
    EXPECT_EQ(one.residuals, two.residuals);
    EXPECT_TRUE(one.shapes == two.shapes);
  }
  omp_set_num_threads(before);
}

}  // namespace
}  // namespace meniscus::modes_test
