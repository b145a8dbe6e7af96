#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/parts.h"

namespace meniscus::element_test {
namespace {

constexpr double kElementRounding =
    1e-12;  // patch and rigid motions: double only

Eigen::MatrixXd dense(const solver::ElementTable& table,
                      const solver::BlockMatrix<double>& matrix) {
  const solver::BlockPattern& p = table.pattern;
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::MatrixXd A(3 * p.nodes, 3 * p.nodes);
  A.setZero();
  for (Eigen::Index i = 0; i < p.nodes; ++i) {
    A.block<3, 3>(3 * i, 3 * i) =
        Eigen::Map<const Block>(matrix.diagonal.data() + 9L * i);
    for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
      const Block b = Eigen::Map<const Block>(matrix.lower.data() + 9L * k);
      const Eigen::Index j = p.column[k];
      A.block<3, 3>(3 * i, 3 * j) = b;
      A.block<3, 3>(3 * j, 3 * i) = b.transpose();
    }
  }
  return A;
}

TetMesh single_element(int order) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1.2, 0.1, 0}, {0.2, 0.9, 0.1}, {0.1, 0.3, 1.1}};
  mesh.corner_count = 4;
  mesh.elements = {0, 1, 2, 3};
  mesh.element_region = {0};
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
    mesh.nodes[5] += Vec3(0.05, 0.03, -0.02);  // curved
  }
  return mesh;
}

VectorX rigid_motion(const TetMesh& mesh, const Vec3& shift, const Vec3& turn) {
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        shift + turn.cross(mesh.nodes[i]);
  }
  return u;
}

class Element : public testing::TestWithParam<int> {};

TEST_P(Element, StiffnessIsSymmetricWithSixZeroEigenvalues) {
  const TetMesh mesh = single_element(GetParam());
  const solver::ElementTable table = parts::table_of(mesh);
  solver::BlockMatrix<double> matrix;
  ASSERT_FALSE(solver::assemble(table, mesh.nodes,
                                {element::lame(parts::steel())}, matrix));
  const Eigen::MatrixXd K = dense(table, matrix);
  EXPECT_LE((K - K.transpose()).norm(), kElementRounding * K.norm());
  const VectorX values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
  const double top = values[values.size() - 1];
  for (int k = 0; k < 6; ++k) {
    EXPECT_LE(std::abs(values[k]), kElementRounding * top);
  }
  EXPECT_GT(values[6], 1e-6 * top);
}

TEST_P(Element, RigidMotionGivesNoForce) {
  const TetMesh mesh = single_element(GetParam());
  const solver::ElementTable table = parts::table_of(mesh);
  const std::vector<element::ElasticLaw> laws = {element::lame(parts::steel())};
  const VectorX u = rigid_motion(mesh, {1.0, -2.0, 0.5}, {0.3, 0.2, -0.7});
  const VectorX f = solver::internal_forces(table, mesh.nodes, laws, u);
  EXPECT_LE(f.norm(),
            kElementRounding * parts::steel().youngs_modulus * u.norm());
}

TEST_P(Element, InternalForcesAreTheStiffnessTimesTheDisplacement) {
  const TetMesh mesh = single_element(GetParam());
  const solver::ElementTable table = parts::table_of(mesh);
  const std::vector<element::ElasticLaw> laws = {element::lame(parts::steel())};
  solver::BlockMatrix<double> matrix;
  ASSERT_FALSE(solver::assemble(table, mesh.nodes, laws, matrix));
  VectorX u(3 * table.pattern.nodes);
  for (Eigen::Index d = 0; d < u.size(); ++d) {
    u[d] = std::sin(static_cast<double>(d) + 1.0);
  }
  const VectorX expected = dense(table, matrix) * u;
  // Two columns of padded layout: u and 2 u.
  constexpr int kColumns = 2;
  Eigen::Matrix4Xd x =
      Eigen::Matrix4Xd::Zero(4, kColumns * table.pattern.nodes);
  Eigen::Matrix4Xd y = x;
  for (int n = 0; n < table.pattern.nodes; ++n) {
    x.col(kColumns * n).head<3>() = u.segment<3>(3L * n);
    x.col(kColumns * n + 1).head<3>() = 2.0 * u.segment<3>(3L * n);
  }
  solver::multiply<3, kColumns>(table.pattern, matrix, x.data(), y.data());
  VectorX product(u.size());
  for (int n = 0; n < table.pattern.nodes; ++n) {
    product.segment<3>(3L * n) = y.col(kColumns * n).head<3>();
    EXPECT_LE((y.col(kColumns * n + 1).head<3>() -
               2.0 * y.col(kColumns * n).head<3>())
                  .norm(),
              kElementRounding * expected.norm());
  }
  EXPECT_LE((product - expected).norm(), kElementRounding * expected.norm());
  EXPECT_LE(
      (solver::internal_forces(table, mesh.nodes, laws, u) - expected).norm(),
      kElementRounding * expected.norm());
}

/// Largest internal force at nodes off the boundary, over the largest of all.
double inner_force(const TetMesh& mesh, const VectorX& u) {
  const VectorX f = solver::internal_forces(parts::table_of(mesh), mesh.nodes,
                                            {element::lame(parts::steel())}, u);
  std::vector<char> boundary(mesh.nodes.size(), 0);
  for (const int node : mesh.faces) {
    boundary[node] = 1;
  }
  double inner = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const double size = f.segment<3>(static_cast<Eigen::Index>(3 * i)).norm();
    all = std::max(all, size);
    inner = std::max(inner, boundary[i] != 0 ? 0.0 : size);
  }
  return inner / all;
}

TEST_P(Element, PatchOfAnyLinearFieldIsInEquilibrium) {
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 4);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  Mat3 H;
  H << 1.0, 0.4, -0.2, 0.3, -0.7, 0.5, 0.1, 0.6, 0.2;
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) = H * mesh.nodes[i];
  }
  EXPECT_LE(inner_force(mesh, u), kElementRounding);
}

TEST(BendingPatch, OfQuadraticElementsIsInEquilibriumWithExactStress) {
  const TetMesh mesh =
      shapes::straight_quadratic(parts::distorted_brick({1.0, 2.0, 1.5}, 4));
  const double k = 0.7;
  const double nu = parts::steel().poisson_ratio;
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        Vec3(-k * x.x() * x.y(),
             0.5 * k * (x.x() * x.x() + nu * (x.y() * x.y() - x.z() * x.z())),
             k * nu * x.y() * x.z());
  }
  EXPECT_LE(inner_force(mesh, u), kElementRounding);
  const stress::StressField stress =
      stress::recover_stress(mesh, {parts::steel()}, u);
  const double E = parts::steel().youngs_modulus;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const double exact = -E * k * mesh.nodes[i].y();
    EXPECT_NEAR(stress.nodal[i][0], exact, 1e-11 * E);
    for (int c = 1; c < 6; ++c) {
      EXPECT_NEAR(stress.nodal[i][c], 0.0, 1e-11 * E);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, Element, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::element_test
