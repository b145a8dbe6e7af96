#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/parts.h"

namespace meniscus::material_test {
namespace {

constexpr double kMaterialRounding = 1e-12;
constexpr double kDirectSolver = 1e-10;  // displacements of the direct solver

/// Spruce, MPa, along a direction that is no axis of the mesh.
element::Material spruce() {
  element::Material m = parts::steel();
  m.name = "spruce";
  m.orthotropic = element::Orthotropic{{10800.0, 842.0, 464.0},
                                       {0.372, 0.467, 0.435},
                                       {690.0, 670.0, 32.0},
                                       {{1.0, 2.0, -0.5}, {0.3, 1.0, 1.0}}};
  return m;
}

/// Steel, written as an orthotropic material.
element::Material orthotropic_steel() {
  element::Material m = parts::steel();
  const double E = m.youngs_modulus;
  const double nu = m.poisson_ratio;
  m.orthotropic = element::Orthotropic{Vec3::Constant(E),
                                       Vec3::Constant(nu),
                                       Vec3::Constant(0.5 * E / (1.0 + nu)),
                                       {{1.0, -1.0, 3.0}, {0.0, 1.0, 1.0}}};
  return m;
}

TEST(OrthotropicLaw, OfEqualConstantsIsTheIsotropicOneInAnyAxes) {
  const element::Mat6 D = element::elastic_law(orthotropic_steel()).stiffness;
  const element::Mat6 exact = element::elastic_law(parts::steel()).stiffness;
  EXPECT_LE((D - exact).norm(), kMaterialRounding * exact.norm());
}

TEST(OrthotropicLaw, PullAlongAnAxisContractsByItsRatios) {
  const element::Material material = spruce();
  const element::Orthotropic& m = *material.orthotropic;
  const Mat3 R = element::unit_axes(m.axes);
  EXPECT_LE((R.transpose() * R - Mat3::Identity()).norm(), kMaterialRounding);
  EXPECT_GT(R.determinant(), 0.0);
  // Unit stress along axis 1 and along the shear 23, in the mesh's axes.
  Mat3 strain = Vec3(1.0, -m.poisson_ratios[0], -m.poisson_ratios[1])
                    .cwiseQuotient(Vec3::Constant(m.youngs_moduli[0]))
                    .asDiagonal();
  strain(1, 2) = strain(2, 1) = 0.5 / m.shear_moduli[2];
  Mat3 own = Mat3::Zero();
  own(0, 0) = 1.0;
  own(1, 2) = own(2, 1) = 1.0;
  const Mat3 stress =
      element::elastic_law(material).stress(R * strain * R.transpose());
  EXPECT_LE((stress - R * own * R.transpose()).norm(), kMaterialRounding * 1e2);
}

class OrthotropicElement : public testing::TestWithParam<int> {};

TEST_P(OrthotropicElement, StiffnessOfEqualConstantsIsTheIsotropicOne) {
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 2);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  const solver::ElementTable table = parts::table_of(mesh);
  solver::BlockMatrix<double> general;
  solver::BlockMatrix<double> isotropic;
  solver::assemble(table, mesh.nodes,
                   element::elastic_laws({orthotropic_steel()}), general);
  solver::assemble(table, mesh.nodes, element::elastic_laws({parts::steel()}),
                   isotropic);
  const double size = parts::steel().youngs_modulus;
  for (std::size_t k = 0; k < general.lower.size(); ++k) {
    EXPECT_NEAR(general.lower[k], isotropic.lower[k], kMaterialRounding * size);
  }
  for (std::size_t k = 0; k < general.diagonal.size(); ++k) {
    EXPECT_NEAR(general.diagonal[k], isotropic.diagonal[k],
                kMaterialRounding * size);
  }
}

TEST_P(OrthotropicElement, InternalForcesAreTheStiffnessTimesDisplacement) {
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 2);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  const solver::ElementTable table = parts::table_of(mesh);
  const std::vector<element::ElasticLaw> laws =
      element::elastic_laws({spruce()});
  solver::BlockMatrix<double> matrix;
  ASSERT_FALSE(solver::assemble(table, mesh.nodes, laws, matrix));
  VectorX u(3 * table.pattern.nodes);
  for (Eigen::Index d = 0; d < u.size(); ++d) {
    u[d] = std::sin(static_cast<double>(d) + 1.0);
  }
  const VectorX product = parts::product(table, matrix, u);
  EXPECT_LE(
      (solver::internal_forces(table, mesh.nodes, laws, u) - product).norm(),
      kMaterialRounding * product.norm());
}

TEST_P(OrthotropicElement, PulledBlockTakesTheUniformStrain) {
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 3);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  // Axes along the mesh's, turned by one place: x is axis 3, y 1, z 2.
  element::Material material = spruce();
  material.orthotropic->axes.first = Vec3::UnitY();
  material.orthotropic->axes.second = Vec3::UnitZ();
  loads::LoadCase pull;
  pull.name = "pull";
  pull.supports = {{"x0", true, false, false},
                   {"y0", false, true, false},
                   {"z0", false, false, true}};
  pull.forces = {{"x1", {3.0, 0.0, 0.0}}};  // unit stress on 2 x 1.5
  const elastic::ElasticModel model(
      mesh, {material}, {pull}, {.solver = equations::SolverKind::Cholesky});
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  const element::Orthotropic& m = *material.orthotropic;
  const Vec3 strain =
      Vec3(1.0 / m.youngs_moduli[2], -m.poisson_ratios[1] / m.youngs_moduli[0],
           -m.poisson_ratios[2] / m.youngs_moduli[1]);
  double error = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 u =
        solution.displacements[0].segment<3>(static_cast<Eigen::Index>(3 * i));
    error = std::max(error, (u - strain.cwiseProduct(mesh.nodes[i])).norm());
  }
  EXPECT_LE(error, kDirectSolver * strain.norm());
  const stress::StressField stress =
      stress::recover_stress(mesh, {material}, solution.displacements[0]);
  EXPECT_NEAR(stress.max_von_mises, 1.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Orders, OrthotropicElement, testing::Values(1, 2));

TEST(OrthotropicSolve, MultigridAgreesWithCholesky) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({3.0, 1.0, 1.0}, 9, 3, 3));
  const loads::LoadCase load_case = parts::pulled({0.0, 1.0, -2.0});
  const elastic::ElasticModel a(mesh, {spruce()}, {load_case},
                                {.solver = equations::SolverKind::Multigrid});
  const elastic::ElasticModel b(mesh, {spruce()}, {load_case},
                                {.solver = equations::SolverKind::Cholesky});
  ASSERT_FALSE(a.base_solution().failure) << a.base_solution().failure->message;
  const VectorX& u = b.base_solution().displacements[0];
  EXPECT_LE((a.base_solution().displacements[0] - u).norm(), 1e-8 * u.norm());
}

/// The element kernels see only the law, so its energy must be positive.
TEST(OrthotropicLaw, StiffnessIsPositiveDefinite) {
  const element::Mat6 D = element::elastic_law(spruce()).stiffness;
  EXPECT_LE((D - D.transpose()).norm(), kMaterialRounding * D.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<element::Mat6>(D).eigenvalues()[0],
            0.0);
}

void expect_refused(const element::Material& material, const char* part) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THAT(
      [&] { element::check_materials(mesh, {material}); },
      testing::ThrowsMessage<InvalidInput>(testing::AllOf(
          testing::HasSubstr(material.name), testing::HasSubstr(part))));
}

TEST(OrthotropicChecks, RefuseWhatMakesNoPositiveStiffness) {
  element::Material m = spruce();
  m.orthotropic->poisson_ratios[0] = 3.7;  // above sqrt(E1 / E2) = 3.58
  expect_refused(m, "positive definite");
  m = orthotropic_steel();
  m.orthotropic->poisson_ratios.setConstant(0.5);  // incompressible
  expect_refused(m, "positive definite");
  m.orthotropic->poisson_ratios[2] = NAN;
  expect_refused(m, "positive definite");
}

TEST(OrthotropicChecks, RefuseModuliAxesAndExpansions) {
  element::Material m = spruce();
  m.orthotropic->shear_moduli[1] = 0.0;
  expect_refused(m, "shear moduli");
  m = spruce();
  m.orthotropic->youngs_moduli[2] = INFINITY;
  expect_refused(m, "Young's moduli");
  m = spruce();
  m.orthotropic->axes.second = -2.0 * m.orthotropic->axes.first;
  expect_refused(m, "parallel");
  m.orthotropic->axes.first.setZero();
  expect_refused(m, "no length");
  m = spruce();
  m.thermal_expansion[1] = NAN;
  expect_refused(m, "expansion");
  m = parts::steel();
  m.thermal_expansion = {1e-5, 1e-5, 2e-5};
  expect_refused(m, "isotropic");
}

}  // namespace
}  // namespace meniscus::material_test
