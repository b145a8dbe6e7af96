#include "fea/stress/error_estimate.h"

#include <cmath>
#include <omp.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/stress/averaged_stress.h"
#include "fea/stress/peak_stress.h"
#include "tests/support/parts.h"

namespace meniscus::error_estimate_test {
namespace {

constexpr double kEstimateRounding =
    1e-9;  // of the energy norm: patches lose digits

template <class Field>
VectorX nodal(const TetMesh& mesh, const Field& field) {
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) = field(mesh.nodes[i]);
  }
  return u;
}

TetMesh distorted(int order) {
  const TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 4);
  return order == 2 ? shapes::straight_quadratic(mesh) : mesh;
}

stress::RecoveredStress recovered(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const VectorX& u, const VectorX& heat = {}) {
  return stress::recover_by_patches(
      mesh, element::point_stress(mesh, materials, u, heat));
}

stress::EnergyError error_of(const TetMesh& mesh,
                             const std::vector<element::Material>& materials,
                             const VectorX& u, const VectorX& heat = {}) {
  return stress::estimate_error(mesh, materials,
                                {u, recovered(mesh, materials, u, heat), heat});
}

Vec3 wavy(const Vec3& x) {
  return 1e-3 *
         Vec3(std::sin(3.0 * x.y()), x.x() * x.z(), std::cos(2.0 * x.x()));
}

class ErrorEstimate : public testing::TestWithParam<int> {};

TEST_P(ErrorEstimate, IsNoneForLinearFields) {
  const TetMesh mesh = distorted(GetParam());
  const VectorX u = nodal(mesh, [](const Vec3& x) -> Vec3 {
    return {0.1 * x.x() + 0.3 * x.z(), -0.2 * x.y(), 0.1 * x.x()};
  });
  const stress::EnergyError error = error_of(mesh, {parts::steel()}, u);
  EXPECT_LE(error.error, kEstimateRounding * error.energy_norm);
  EXPECT_LE(error.relative(), kEstimateRounding);
}

TEST(ErrorEstimate, IsNoneForBendingOfTenNodeElements) {
  const TetMesh mesh = distorted(2);
  const double nu = parts::steel().poisson_ratio;
  const VectorX u = nodal(mesh, [nu](const Vec3& x) -> Vec3 {
    return {-x.x() * x.y(),
            0.5 * (x.x() * x.x() + nu * (x.y() * x.y() - x.z() * x.z())),
            nu * x.y() * x.z()};
  });
  const stress::EnergyError error = error_of(mesh, {parts::steel()}, u);
  EXPECT_LE(error.error, kEstimateRounding * error.energy_norm);
  // Twice the energy of bending: E int y^2 dV.
  EXPECT_NEAR(error.energy_norm,
              std::sqrt(parts::steel().youngs_modulus * 1.5 * 8.0 / 3.0),
              kEstimateRounding * error.energy_norm);
}

TEST_P(ErrorEstimate, IsNoneWhereStressesJumpBetweenMaterials) {
  TetMesh mesh = shapes::brick({2.0, 1.0, 1.0}, 8, 4, 4);
  if (GetParam() == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    double x = 0.0;
    for (const int node : mesh.element(e).first<4>()) {
      x += 0.25 * mesh.nodes[node].x();
    }
    mesh.element_region[e] = x < 1.0 ? 0 : 1;
  }
  element::Material soft = parts::steel();
  soft.youngs_modulus /= 3.0;
  // Stretched along y alike: the stiffer half carries three times the stress.
  const VectorX u = nodal(mesh, [](const Vec3& x) -> Vec3 {
    return {0.0, 0.01 * x.y(), 0.0};
  });
  const stress::EnergyError error = error_of(mesh, {parts::steel(), soft}, u);
  EXPECT_LE(error.error, kEstimateRounding * error.energy_norm);
}

TEST_P(ErrorEstimate, TakesFreeExpansionOut) {
  const TetMesh mesh = distorted(GetParam());
  element::Material steel = parts::steel();
  steel.thermal_expansion.setConstant(1e-5);
  const VectorX u = nodal(mesh, [](const Vec3& x) -> Vec3 { return 1e-3 * x; });
  const VectorX heat =
      VectorX::Constant(static_cast<Eigen::Index>(mesh.nodes.size()), 100.0);
  const stress::EnergyError cold = error_of(mesh, {steel}, u);
  const stress::EnergyError hot = error_of(mesh, {steel}, u, heat);
  EXPECT_LE(hot.error, kEstimateRounding * cold.energy_norm);
  EXPECT_LE(hot.energy_norm, kEstimateRounding * cold.energy_norm);
}

TEST_P(ErrorEstimate, HasTheSameBitsOnOneAndTwoThreads) {
  const TetMesh mesh = distorted(GetParam());
  const VectorX u = nodal(mesh, wavy);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const stress::EnergyError one = error_of(mesh, {parts::steel()}, u);
  omp_set_num_threads(2);
  const stress::EnergyError two = error_of(mesh, {parts::steel()}, u);
  omp_set_num_threads(before);
  EXPECT_EQ(one.element, two.element);
  EXPECT_EQ(one.error, two.error);
  EXPECT_EQ(one.energy_norm, two.energy_norm);
}

TEST_P(ErrorEstimate, OfAResponseIsSymmetricAndBounded) {
  const TetMesh mesh = distorted(GetParam());
  const std::vector<element::Material> steel = {parts::steel()};
  const VectorX u = nodal(mesh, wavy);
  const VectorX z = nodal(mesh, [](const Vec3& x) -> Vec3 {
    return 1e-3 * Vec3(x.z() * x.z(), std::sin(x.x()), x.x() * x.y());
  });
  const stress::RecoveredStress su = recovered(mesh, steel, u);
  const stress::RecoveredStress sz = recovered(mesh, steel, z);
  const stress::ResponseError there =
      stress::response_error(mesh, steel, {u, su, {}}, {z, sz, {}});
  const stress::ResponseError back =
      stress::response_error(mesh, steel, {z, sz, {}}, {u, su, {}});
  EXPECT_NEAR(there.value, back.value, kEstimateRounding * there.bound);
  EXPECT_GE(there.bound, std::abs(there.value));
  // With itself: the squared energy error.
  const stress::ResponseError self =
      stress::response_error(mesh, steel, {u, su, {}}, {u, su, {}});
  const stress::EnergyError energy =
      stress::estimate_error(mesh, steel, {u, su, {}});
  EXPECT_NEAR(self.value, energy.error * energy.error,
              kEstimateRounding * self.value);
  EXPECT_NEAR(self.bound, self.value, kEstimateRounding * self.value);
}

TEST_P(ErrorEstimate, RefusesWhatDoesNotFit) {
  const TetMesh mesh = distorted(GetParam());
  const std::vector<element::Material> steel = {parts::steel()};
  const VectorX u = nodal(mesh, wavy);
  const stress::RecoveredStress stress = recovered(mesh, steel, u);
  EXPECT_THROW(
      stress::estimate_error(mesh, steel, {VectorX::Zero(3), stress, {}}),
      InvalidInput);
  EXPECT_THROW(stress::estimate_error(mesh, steel, {u, {}, {}}), InvalidInput);
  EXPECT_THROW(
      stress::estimate_error(mesh, steel, {u, stress, VectorX::Zero(2)}),
      InvalidInput);
  EXPECT_THROW(stress::estimate_error(mesh, {}, {u, stress, {}}), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, ErrorEstimate, testing::Values(1, 2));

TEST(SafetyFactors, AreEachRegionsOwnAndTellThePlace) {
  TetMesh mesh = shapes::brick({2.0, 1.0, 1.0}, 4, 2, 2);
  for (int e = 0; e < mesh.element_count(); ++e) {
    double x = 0.0;
    for (const int node : mesh.element(e)) {
      x += 0.25 * mesh.nodes[node].x();
    }
    mesh.element_region[e] = x < 1.0 ? 0 : 1;
  }
  element::Material strong = parts::steel();
  strong.yield_strength = 400.0;
  element::Material weak = strong;
  weak.yield_strength = 50.0;
  // A uniform pull of 100 along x.
  const double strain = 100.0 / strong.youngs_modulus;
  const double nu = strong.poisson_ratio;
  const VectorX u = nodal(mesh, [&](const Vec3& x) -> Vec3 {
    return strain * Vec3(x.x(), -nu * x.y(), -nu * x.z());
  });
  const auto safety = [&](const std::vector<element::Material>& materials) {
    const element::PointStress points =
        element::point_stress(mesh, {strong, weak}, u);
    return stress::safety_factor(
        {mesh, recovered(mesh, {strong, weak}, u),
         stress::average_extrapolations(mesh, points), points},
        materials);
  };
  const stress::SafetyFactor both = safety({strong, weak});
  EXPECT_NEAR(both.smallest, 0.5, kEstimateRounding);
  EXPECT_EQ(both.region, 1);
  EXPECT_GE(both.position.x(), 1.0 - kEstimateRounding);
  EXPECT_NEAR(both.von_mises, 100.0, 1e-7);
  weak.yield_strength.reset();
  const stress::SafetyFactor one = safety({strong, weak});
  EXPECT_NEAR(one.smallest, 4.0, 1e-7);
  EXPECT_THROW(safety({strong}), InvalidInput);
  strong.yield_strength.reset();
  EXPECT_TRUE(std::isinf(safety({strong, weak}).smallest));
}

}  // namespace
}  // namespace meniscus::error_estimate_test
