/// Closed forms of linear elasticity, with the rate at which they are reached.
#include <gtest/gtest.h>

#include "tests/support/parts.h"

namespace meniscus::elasticity_test {
namespace {

/// Deflection of a cantilever of square section under an end force: bending
/// and Timoshenko's shear with Cowper's k = 10 (1 + nu) / (12 + 11 nu).
TEST(Cantilever, DeflectionConvergesToTimoshenkosBeam) {
  const double length = 10.0;
  const double force = 1.0;
  const element::Material steel = parts::steel();
  const double E = steel.youngs_modulus;
  const double nu = steel.poisson_ratio;
  const double k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
  const double G = E / (2.0 * (1.0 + nu));
  const double exact =
      force * std::pow(length, 3) / (3.0 * E / 12.0) + force * length / (k * G);
  std::vector<double> error;
  double last = 0.0;
  for (const int n : {1, 2, 4}) {
    const TetMesh mesh = shapes::straight_quadratic(
        shapes::brick({length, 1.0, 1.0}, 5 * n, n, n));
    const elastic::ElasticModel model(mesh, {steel},
                                      {parts::pulled({0, 0, -force})});
    ASSERT_FALSE(model.base_solution().failure);
    const double deflection = loads::mean_displacement(
        mesh, "x1", {0.0, 0.0, -1.0}, model.base_solution().displacements[0]);
    EXPECT_GT(deflection, last);  // stiffness falls as the mesh refines
    last = deflection;
    error.push_back(std::abs(deflection / exact - 1.0));
  }
  EXPECT_LT(error[2], 0.01);
  EXPECT_LT(error[1], 0.02);
}

/// Lame's thick cylinder a = 1, b = 2, plane strain, pressure in the bore.
TEST(ThickCylinder, CurvedElementsConverge) {
  const double p = 100.0;
  const element::Material steel = parts::steel();
  const double E = steel.youngs_modulus;
  const double nu = steel.poisson_ratio;
  const auto radial = [&](double r) {
    return (1.0 + nu) * p / (E * 3.0) * ((1.0 - 2.0 * nu) * r + 4.0 / r);
  };
  std::vector<double> displacement_error;
  std::vector<double> stress_error;
  for (const int n : {2, 4, 8}) {
    const TetMesh mesh = parts::quarter_tube(n, 1.0 / n);
    const elastic::ElasticModel model(mesh, {steel}, {parts::tube_pressure(p)});
    ASSERT_FALSE(model.base_solution().failure);
    const VectorX& u = model.base_solution().displacements[0];
    const stress::StressField stress = stress::recover_stress(mesh, {steel}, u);
    double sum = 0.0;
    double hoop = 0.0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Vec3& x = mesh.nodes[i];
      const double r = std::hypot(x.x(), x.y());
      const Vec3 exact = radial(r) * Vec3(x.x() / r, x.y() / r, 0.0);
      sum += (u.segment<3>(static_cast<Eigen::Index>(3 * i)) - exact)
                 .squaredNorm();
      if (r < 1.0 + 1e-9 && x.y() < 1e-9) {
        hoop = std::max(hoop,
                        std::abs(stress.nodal[i][1] / (p * 5.0 / 3.0) - 1.0));
      }
    }
    displacement_error.push_back(
        std::sqrt(sum / static_cast<double>(mesh.nodes.size())) / radial(1.0));
    stress_error.push_back(hoop);
  }
  // L2 order 3 for curved ten-node elements: a factor of 8 a refinement.
  EXPECT_GT(displacement_error[1] / displacement_error[2], 6.0);
  EXPECT_LT(displacement_error[2], 1e-4);
  EXPECT_GT(stress_error[1] / stress_error[2], 2.0);
  EXPECT_LT(stress_error[2], 0.02);
}

/// The same cylinder with four-node elements: L2 order 2.
TEST(ThickCylinder, FourNodeElementsConverge) {
  const double p = 100.0;
  const element::Material steel = parts::steel();
  const double nu = steel.poisson_ratio;
  std::vector<double> error;
  for (const int n : {4, 8, 16}) {
    const TetMesh curved = parts::quarter_tube(n, 1.0 / n);
    TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, n, 2 * n, 1);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      mesh.nodes[i] = curved.nodes[i];
    }
    const elastic::ElasticModel model(mesh, {steel}, {parts::tube_pressure(p)});
    ASSERT_FALSE(model.base_solution().failure);
    const VectorX& u = model.base_solution().displacements[0];
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Vec3& x = mesh.nodes[i];
      const double r = std::hypot(x.x(), x.y());
      const double ur = (1.0 + nu) * p / (steel.youngs_modulus * 3.0) *
                        ((1.0 - 2.0 * nu) * r + 4.0 / r);
      sum += (u.segment<3>(static_cast<Eigen::Index>(3 * i)) -
              ur * Vec3(x.x() / r, x.y() / r, 0.0))
                 .squaredNorm() /
             (ur * ur);
    }
    error.push_back(std::sqrt(sum / static_cast<double>(mesh.nodes.size())));
  }
  EXPECT_GT(error[0] / error[1], 3.2);
  EXPECT_GT(error[1] / error[2], 3.4);
}

}  // namespace
}  // namespace meniscus::elasticity_test
