/// The exact fields that the verification compares with are in equilibrium and
/// have the stress concentrations of the books.
#include <gtest/gtest.h>

#include "tests/support/exact_elasticity.h"
#include "tests/support/parts.h"

namespace meniscus::exact_fields_test {
namespace {

constexpr double kRounding = 1e-12;

Vec3 traction(const exact::Field& field, const Vec3& x, const Vec3& normal) {
  const element::Stress s = field.at(x).stress;
  return element::stress_tensor(Eigen::Map<const element::Vec6>(s.data())) *
         normal;
}

TEST(ExactField, CylinderAndSphereCarryTheirPressures) {
  const element::Material steel = parts::steel();
  const exact::Field tube = exact::thick_cylinder(steel, 1.0, 2.0, 3.0);
  const exact::Field shell = exact::thick_sphere(steel, 1.0, 2.0, 3.0);
  const Vec3 n(0.6, 0.8, 0.0);
  const Vec3 m = Vec3(0.6, 0.5, -0.7).normalized();
  EXPECT_LE((traction(tube, n, n) + 3.0 * n).norm(), 3.0 * kRounding);
  EXPECT_LE(traction(tube, 2.0 * n, n).norm(), 3.0 * kRounding);
  EXPECT_LE((traction(shell, m, m) + 3.0 * m).norm(), 3.0 * kRounding);
  EXPECT_LE(traction(shell, 2.0 * m, m).norm(), 3.0 * kRounding);
  EXPECT_LE(tube.at({1.1, 0.7, 0.2}).body_force.norm(), 10.0 * kRounding);
  EXPECT_LE(shell.at({1.1, 0.7, 0.2}).body_force.norm(), 10.0 * kRounding);
  EXPECT_NEAR(tube.at({1.0, 0.0, 0.0}).stress[1], 5.0, 1e-11);
  EXPECT_NEAR(shell.at({1.0, 0.0, 0.0}).stress[1], 3.0 * 5.0 / 7.0, 1e-11);
  EXPECT_NEAR(shell.at({2.0, 0.0, 0.0}).stress[1], 3.0 * 3.0 / 14.0, 1e-11);
}

TEST(ExactField, HoleInAPlateIsKirschs) {
  const exact::Field plate = exact::hole_in_plate(parts::steel(), 1.0, 2.0);
  for (const double t : {0.0, 0.3, 1.1, 1.5}) {
    const Vec3 n(std::cos(t), std::sin(t), 0.0);
    EXPECT_LE(traction(plate, n, n).norm(), 10.0 * kRounding);
    EXPECT_LE(plate.at(1.7 * n).body_force.norm(), 10.0 * kRounding);
  }
  EXPECT_NEAR(plate.at({0.0, 1.0, 0.0}).stress[0], 6.0, 1e-11);
  EXPECT_NEAR(plate.at({1.0, 0.0, 0.0}).stress[1], -2.0, 1e-11);
  EXPECT_NEAR(plate.at({0.0, 1e6, 0.0}).stress[0], 2.0, 1e-9);
}

// Free of traction inside and outside; on each section the moment and no force.
TEST(ExactField, BentRingIsGolovins) {
  const double a = 2.0;
  const double b = 3.0;
  const exact::Field ring = exact::bent_ring(parts::steel(), a, b, 5.0);
  for (const double t : {0.0, 0.4, 1.2}) {
    const Vec3 n(std::cos(t), std::sin(t), 0.0);
    const Vec3 along(-n.y(), n.x(), 0.0);
    EXPECT_LE(traction(ring, a * n, n).norm(), 1e-11);
    EXPECT_LE(traction(ring, b * n, n).norm(), 1e-11);
    EXPECT_LE(ring.at(2.3 * n).body_force.norm(), 1e-11);
    constexpr int kSteps = 2000;
    Vec3 force = Vec3::Zero();
    double moment = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double r = a + (b - a) * (k + 0.5) / kSteps;
      const Vec3 pull = traction(ring, r * n, along) * (b - a) / kSteps;
      force += pull;
      moment += r * pull.dot(along);
    }
    EXPECT_LE(force.norm(), 1e-5);
    EXPECT_NEAR(std::abs(moment), 5.0, 1e-5);
    EXPECT_GT(traction(ring, a * n, along).dot(along), 0.0);
  }
  EXPECT_NEAR(ring.at({2.5, 0.0, 0.0}).u.y(), 0.0, 1e-15);
}

TEST(ExactField, SphericalCavityIsGoodiers) {
  const element::Material steel = parts::steel();
  const double nu = steel.poisson_ratio;
  const exact::Field solid = exact::spherical_cavity(steel, 2.0);
  for (const double t : {0.0, 0.3, 1.1, 1.5}) {
    const Vec3 n(std::cos(t) * 0.6, std::cos(t) * 0.8, std::sin(t));
    EXPECT_LE(traction(solid, n, n).norm(), 10.0 * kRounding);
    EXPECT_LE(solid.at(1.7 * n).body_force.norm(), 10.0 * kRounding);
  }
  const double kt = (27.0 - 15.0 * nu) / (2.0 * (7.0 - 5.0 * nu));
  EXPECT_NEAR(kt, 2.045455, 1e-6);
  EXPECT_NEAR(solid.at({1.0, 0.0, 0.0}).stress[2], 2.0 * kt, 1e-11);
  EXPECT_NEAR(solid.at({0.0, 1e4, 0.0}).stress[2], 2.0, 1e-9);
}

}  // namespace
}  // namespace meniscus::exact_fields_test
