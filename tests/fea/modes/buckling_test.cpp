/// Linear buckling: what the answer must satisfy.
#include "fea/modes/buckling.h"

#include <cmath>
#include <omp.h>

#include <gtest/gtest.h>

#include "fea/element/elastic_law.h"
#include "tests/support/eigen_parts.h"

namespace meniscus::buckling_test {
namespace {

TetMesh column(int order) {
  const TetMesh mesh = shapes::brick({8.0, 1.0, 0.7}, 12, 2, 2);
  return order == 1 ? mesh : shapes::straight_quadratic(mesh);
}

struct Loaded {
  TetMesh mesh;
  std::vector<loads::LoadCase> cases;
  elastic::ElasticModel model;

  Loaded(TetMesh m, const Vec3& force)
      : mesh(std::move(m)),
        cases({parts::pulled(force)}),
        model(mesh, {parts::steel()}, cases) {}

  modes::BucklingModes buckle(
      const modes::BucklingOptions& options = {}) const {
    return modes::buckling_modes(
        model, mesh, cases, 0, model.base_solution().displacements[0], options);
  }
};

class Buckling : public testing::TestWithParam<int> {};

TEST_P(Buckling, SolvesTheEigenproblem) {
  const Loaded part(column(GetParam()), {-1000.0, 0.0, 0.0});
  const modes::BucklingModes modes = part.buckle({.count = 3});
  ASSERT_FALSE(modes.failure) << modes.failure->message;
  ASSERT_EQ(modes.factors.size(), 3U);
  const solver::ElementTable table = parts::table_of(part.mesh);
  solver::BlockMatrix<double> K;
  ASSERT_FALSE(solver::assemble(table, part.mesh.nodes,
                                element::elastic_laws({parts::steel()}), K));
  const solver::NodalMatrix Kg = solver::geometric_stiffness(
      table, part.mesh.nodes, parts::own_elements(part.mesh),
      element::point_stress(part.mesh, {parts::steel()},
                            part.model.base_solution().displacements[0]));
  for (std::size_t k = 0; k < 3; ++k) {
    const VectorX& x = modes.shapes[k];
    const VectorX Kx = parts::product(table, K, x);
    const VectorX Gx = parts::product(table, Kg, x);
    // Rayleigh's quotient.
    EXPECT_NEAR(x.dot(Kx) / -x.dot(Gx), modes.factors[k],
                1e-9 * modes.factors[k]);
    VectorX r = Kx + modes.factors[k] * Gx;
    for (std::size_t i = 0; i < part.mesh.nodes.size(); ++i) {
      if (part.mesh.nodes[i].x() < 1e-9) {
        r.segment<3>(static_cast<Eigen::Index>(3 * i)).setZero();
      }
    }
    EXPECT_LE(r.norm(), 1e-4 * (modes.factors[k] * Gx).norm());
    EXPECT_NEAR(x.reshaped(3, x.size() / 3).colwise().norm().maxCoeff(), 1.0,
                1e-12);
  }
  EXPECT_LE(modes.factors[0], modes.factors[1]);
}

TEST_P(Buckling, TwiceTheLoadHalvesTheFactor) {
  const double once =
      Loaded(column(GetParam()), {-1000.0, 50.0, 0.0}).buckle().factors.at(0);
  const double twice =
      Loaded(column(GetParam()), {-2000.0, 100.0, 0.0}).buckle().factors.at(0);
  EXPECT_NEAR(once / twice, 2.0, 1e-8);
}

TEST_P(Buckling, TensionHasTheFactorOfReversedCompression) {
  const Loaded pushed(column(GetParam()), {-1000.0, 0.0, 0.0});
  const Loaded pulled(column(GetParam()), {1000.0, 0.0, 0.0});
  EXPECT_NEAR(
      pulled.buckle({.sense = modes::LoadSense::Reversed}).factors.at(0),
      pushed.buckle().factors.at(0), 1e-8 * pushed.buckle().factors.at(0));
}

// No Poisson effect: nothing is compressed anywhere.
TEST_P(Buckling, PureTensionHasNoFactor) {
  const TetMesh mesh = column(GetParam());
  element::Material cork = parts::steel();
  cork.poisson_ratio = 0.0;
  const std::vector<loads::LoadCase> cases = {
      parts::pulled({1000.0, 0.0, 0.0})};
  const elastic::ElasticModel model(mesh, {cork}, cases);
  const modes::BucklingModes modes = modes::buckling_modes(
      model, mesh, cases, 0, model.base_solution().displacements[0],
      {.tolerance = 1e-2, .largest = 1e3});
  EXPECT_FALSE(modes.failure) << modes.failure->message;
  EXPECT_TRUE(modes.factors.empty());
}

INSTANTIATE_TEST_SUITE_P(Orders, Buckling, testing::Values(1, 2));

TEST(BucklingOf, AnUnstressedPartHasNoFactor) {
  const Loaded part(column(1), {-1.0, 0.0, 0.0});
  const VectorX nothing =
      VectorX::Zero(static_cast<Eigen::Index>(3 * part.mesh.nodes.size()));
  const modes::BucklingModes modes =
      modes::buckling_modes(part.model, part.mesh, part.cases, 0, nothing);
  EXPECT_FALSE(modes.failure);
  EXPECT_TRUE(modes.factors.empty());
}

TEST(BucklingOf, WrongInputIsRefused) {
  const Loaded part(column(1), {-1.0, 0.0, 0.0});
  const VectorX& u = part.model.base_solution().displacements[0];
  EXPECT_THROW(part.buckle({.count = 0}), InvalidInput);
  EXPECT_THROW(part.buckle({.largest = 0.0}), InvalidInput);
  EXPECT_THROW(
      modes::buckling_modes(part.model, part.mesh, part.cases, 0, u.head(7)),
      InvalidInput);
  EXPECT_THROW(modes::buckling_modes(part.model, part.mesh, part.cases, 3, u),
               InvalidInput);
  EXPECT_THROW(modes::buckling_modes(part.model, column(2), part.cases, 0, u),
               InvalidInput);
}

TEST(BucklingOf, StressesThatAreNotFiniteAreTold) {
  const Loaded part(column(2), {-1.0, 0.0, 0.0});
  VectorX u = part.model.base_solution().displacements[0];
  u[7] = std::nan("");
  const modes::BucklingModes modes =
      modes::buckling_modes(part.model, part.mesh, part.cases, 0, u);
  ASSERT_TRUE(modes.failure);
  EXPECT_EQ(modes.failure->kind, FailureKind::NotANumber);
  EXPECT_TRUE(modes.factors.empty());
}

class Impatient : public Monitor {
 public:
  bool stop_requested() const override { return true; }
};

TEST(BucklingOf, AMonitorStopsTheSearch) {
  const Loaded part(column(2), {-1.0, 0.0, 0.0});
  Impatient monitor;
  EXPECT_THROW(part.buckle({.monitor = &monitor}), Interrupted);
}

// The model's preconditioner is the base's, K and K_g those of the design.
TEST(BucklingOf, AMovedMeshIsThatOfAModelOfItsOwn) {
  const Loaded base(column(2), {-1000.0, 0.0, 0.0});
  TetMesh moved = base.mesh;
  for (Vec3& x : moved.nodes) {
    x.z() *= 1.0 + 0.02 * x.x();
  }
  const modes::BucklingModes far =
      modes::buckling_modes(base.model, moved, base.cases, 0,
                            base.model.solve(moved).displacements[0]);
  const modes::BucklingModes own = Loaded(moved, {-1000.0, 0.0, 0.0}).buckle();
  ASSERT_FALSE(far.failure) << far.failure->message;
  EXPECT_NEAR(far.factors.at(0), own.factors.at(0), 1e-8 * own.factors.at(0));
}

TEST(BucklingOf, OneAndTwoThreadsGiveTheSameBits) {
  const auto run = [](int threads) {
    omp_set_num_threads(threads);
    return Loaded(shapes::straight_quadratic(
                      shapes::brick({20.0, 2.0, 1.5}, 43, 5, 5)),
                  {-100.0, 0.0, 0.0})
        .buckle({.tolerance = 1e-3});
  };
  const int before = omp_get_max_threads();
  const modes::BucklingModes one = run(1);
  const modes::BucklingModes two = run(2);
  omp_set_num_threads(before);
  ASSERT_FALSE(one.failure) << one.failure->message;
  EXPECT_EQ(one.factors, two.factors);
  EXPECT_TRUE(one.shapes == two.shapes);
}

}  // namespace
}  // namespace meniscus::buckling_test
