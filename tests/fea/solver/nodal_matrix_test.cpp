/// Mass and geometric stiffness: what their forms mean.
#include "fea/solver/nodal_matrix.h"

#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "fea/element/elastic_law.h"
#include "fea/element/tet_element.h"
#include "fea/stress/stress.h"
#include "tests/support/eigen_parts.h"

namespace meniscus::nodal_matrix_test {
namespace {

// Rounding over some thousand sums.
constexpr double kRounding = 1e-12;

TetMesh order_of(const TetMesh& mesh, int order) {
  return order == 1 ? mesh : shapes::straight_quadratic(mesh);
}

class NodalMatrices : public testing::TestWithParam<int> {
 protected:
  TetMesh mesh_ =
      order_of(parts::distorted_brick({2.0, 3.0, 1.5}, 3), GetParam());
};

TEST_P(NodalMatrices, MassOfARigidTranslationIsThePartsMass) {
  TetMesh mesh = mesh_;
  for (int e = 0; e < mesh.element_count() / 3; ++e) {
    mesh.element_region[e] = 1;
  }
  const element::Material light{"light", 1.0, 0.0, 2.5, {}};
  const element::Material heavy{"heavy", 1.0, 0.0, 7.0, {}};
  const solver::ElementTable table = parts::table_of(mesh);
  const solver::NodalMatrix M =
      solver::mass_matrix(table, mesh.nodes, {2.5, 7.0});
  const Vec3 shift(0.3, -2.0, 1.1);
  const VectorX u =
      shift.replicate(static_cast<Eigen::Index>(mesh.nodes.size()), 1);
  const double mass = stress::mesh_mass(mesh, {light, heavy});
  EXPECT_NEAR(u.dot(parts::product(table, M, u)), mass * shift.squaredNorm(),
              kRounding * mass * shift.squaredNorm());
}

// u = x^2 e_y with ten nodes, u = x e_y with four: int rho u^2.
TEST_P(NodalMatrices, MassIsExactOnStraightElements) {
  const solver::ElementTable table = parts::table_of(mesh_);
  const solver::NodalMatrix M = solver::mass_matrix(table, mesh_.nodes, {3.0});
  VectorX u = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh_.nodes.size()));
  const int power = GetParam();
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    u[static_cast<Eigen::Index>(3 * i + 1)] =
        std::pow(mesh_.nodes[i].x(), power);
  }
  const double exact =
      3.0 * 3.0 * 1.5 * std::pow(2.0, 2 * power + 1) / (2 * power + 1);
  EXPECT_NEAR(u.dot(parts::product(table, M, u)), exact, kRounding * exact);
}

TEST_P(NodalMatrices, MassIsPositiveDefinite) {
  const solver::ElementTable table = parts::table_of(mesh_);
  const solver::NodalMatrix M = solver::mass_matrix(table, mesh_.nodes, {1.0});
  for (int seed = 0; seed < 5; ++seed) {
    const VectorX u = parts::irregular(
        static_cast<Eigen::Index>(3 * mesh_.nodes.size()), seed);
    EXPECT_GT(u.dot(parts::product(table, M, u)), 0.0);
  }
}

/// int S : E(u) dV by the stiffness rule, E Green and Lagrange's strain.
template <int Nodes>
double work_of_stress(const TetMesh& mesh, const element::PointStress& stress,
                      const VectorX& u) {
  double work = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    std::array<Vec3, Nodes> x;
    for (int a = 0; a < Nodes; ++a) {
      x[a] = mesh.nodes[mesh.element(e)[a]];
    }
    element::TetGradients<Nodes> g;
    element::tet_gradients<Nodes>(x, g);
    for (int q = 0; q < element::kTetPoints<Nodes>; ++q) {
      Mat3 H = Mat3::Zero();
      for (int a = 0; a < Nodes; ++a) {
        H += u.segment<3>(3L * mesh.element(e)[a]) *
             g.gradient[q][a].transpose();
      }
      const Mat3 E = 0.5 * (H + H.transpose() + H.transpose() * H);
      const element::Stress& s = stress.stress[stress.index(e, q)];
      const Mat3 S =
          element::stress_tensor(Eigen::Map<const element::Vec6>(s.data()));
      work += g.volume[q] * S.cwiseProduct(E).sum();
    }
  }
  return work;
}

// d^2/dt^2 int S : E(t x) = int S : (grad x^T grad x); the work is quadratic in
// t, so that differences of any step are exact.
TEST_P(NodalMatrices, GeometricStiffnessIsTheCurvatureOfTheStressesWork) {
  const solver::ElementTable table = parts::table_of(mesh_);
  const auto unknowns = static_cast<Eigen::Index>(3 * mesh_.nodes.size());
  const element::PointStress stress = element::point_stress(
      mesh_, {parts::steel()}, parts::irregular(unknowns, 0.3));
  const solver::NodalMatrix Kg = solver::geometric_stiffness(
      table, mesh_.nodes, parts::own_elements(mesh_), stress);
  const auto work = [&](const VectorX& u) {
    return GetParam() == 1 ? work_of_stress<4>(mesh_, stress, u)
                           : work_of_stress<10>(mesh_, stress, u);
  };
  const VectorX x = parts::irregular(unknowns, 1.7);
  const double curvature = work(x) - 2.0 * work(0.0 * x) + work(-x);
  const double form = x.dot(parts::product(table, Kg, x));
  EXPECT_NEAR(form, curvature, 1e-10 * std::abs(work(x)));
}

// A turn W x of the stressed part turns its nodal forces: K_g (W x) = W f.
TEST_P(NodalMatrices, GeometricStiffnessTurnsTheInternalForces) {
  const solver::ElementTable table = parts::table_of(mesh_);
  const auto unknowns = static_cast<Eigen::Index>(3 * mesh_.nodes.size());
  const VectorX u = parts::irregular(unknowns, 0.9);
  const solver::NodalMatrix Kg = solver::geometric_stiffness(
      table, mesh_.nodes, parts::own_elements(mesh_),
      element::point_stress(mesh_, {parts::steel()}, u));
  const VectorX f = solver::internal_forces(
      table, mesh_.nodes, element::elastic_laws({parts::steel()}), u);
  const Vec3 axis(0.4, -1.0, 2.0);
  VectorX turn(unknowns);
  VectorX turned(unknowns);
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    turn.segment<3>(at) = axis.cross(mesh_.nodes[i]);
    turned.segment<3>(at) = axis.cross(Vec3(f.segment<3>(at)));
  }
  EXPECT_LE((parts::product(table, Kg, turn) - turned).norm(),
            kRounding * turned.norm());
}

TEST_P(NodalMatrices, SeveralColumnsAreThatOfOne) {
  const solver::ElementTable table = parts::table_of(mesh_);
  const solver::NodalMatrix M = solver::mass_matrix(table, mesh_.nodes, {1.0});
  const int nodes = table.pattern.nodes;
  std::vector<double> x(static_cast<std::size_t>(nodes) * 16, 0.0);
  std::vector<double> y(x.size());
  std::vector<VectorX> u;
  for (int k = 0; k < 4; ++k) {
    u.push_back(parts::irregular(3L * nodes, k));
    for (int i = 0; i < nodes; ++i) {
      for (int c = 0; c < 3; ++c) {
        x[(4L * i + k) * 4 + c] = u[k][3L * i + c];
      }
    }
  }
  solver::multiply<4>(table.pattern, M, x.data(), y.data());
  for (int k = 0; k < 4; ++k) {
    const VectorX alone = parts::product(table, M, u[k]);
    for (int i = 0; i < nodes; ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_DOUBLE_EQ(y[(4L * i + k) * 4 + c], alone[3L * i + c]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, NodalMatrices, testing::Values(1, 2));

// Curved: the determinant is cubic, which both rules integrate exactly.
TEST(NodalMatrix, MassOfACurvedTubeIsItsVolume) {
  const TetMesh mesh = parts::quarter_tube(3, 0.7);
  const solver::ElementTable table = parts::table_of(mesh);
  const solver::NodalMatrix M = solver::mass_matrix(table, mesh.nodes, {1.0});
  VectorX u = VectorX::Zero(static_cast<Eigen::Index>(3 * mesh.nodes.size()));
  for (Eigen::Index k = 0; k < u.size(); k += 3) {
    u[k] = 1.0;
  }
  EXPECT_NEAR(u.dot(parts::product(table, M, u)), stress::mesh_volume(mesh),
              kRounding * stress::mesh_volume(mesh));
}

}  // namespace
}  // namespace meniscus::nodal_matrix_test
