#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/fea/parts.h"

namespace meniscus {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kPi = 3.14159265358979323846;

Vec3 total(const VectorX& f) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index d = 0; d < f.size(); d += 3) {
    sum += f.segment<3>(d);
  }
  return sum;
}

TEST(Loads, WeightsSumToTheAreaAndVanishAtCornersOfFlatQuadraticFaces) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 3, 2));
  const SurfaceWeights w = surface_weights(mesh, "x1");
  EXPECT_NEAR(w.weights.sum(), 12.0, kRounding * 12.0);
  for (std::size_t k = 0; k < w.nodes.size(); ++k) {
    if (w.nodes[k] < mesh.corner_count) {
      EXPECT_NEAR(w.weights[static_cast<Eigen::Index>(k)], 0.0, kRounding);
    }
  }
}

TEST(Loads, ForceIsSpreadToItsTotal) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  const Vec3 force(3.0, -5.0, 7.0);
  const VectorX f = nodal_forces(mesh, parts::pulled(force));
  EXPECT_LE((total(f) - force).norm(), kRounding * force.norm());
}

TEST(Loads, PressurePushesIntoTheSolidAndBalancesAllRound) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  LoadCase one;
  one.pressures = {{"x1", 2.0}};
  EXPECT_LE((total(nodal_forces(mesh, one)) - Vec3(-24.0, 0.0, 0.0)).norm(),
            kRounding * 24.0);
  LoadCase all;
  for (const std::string& name : mesh.labels) {
    all.pressures.push_back({name, 2.0});
  }
  EXPECT_LE(total(nodal_forces(mesh, all)).norm(), kRounding * 24.0);
}

TEST(Loads, CurvedAreaAndVolumeConverge) {
  double area_error[2];
  double volume_error[2];
  for (int k = 0; k < 2; ++k) {
    const TetMesh mesh = parts::quarter_tube(k == 0 ? 2 : 4, 1.0);
    area_error[k] =
        std::abs(surface_weights(mesh, "x0").weights.sum() - 0.5 * kPi);
    volume_error[k] = std::abs(mesh_volume(mesh) - 0.75 * kPi);
  }
  EXPECT_GT(area_error[0] / area_error[1], 12.0);      // order 4
  EXPECT_GT(volume_error[0] / volume_error[1], 12.0);  // order 4
  EXPECT_LT(volume_error[1], 1e-4);
}

TEST(Loads, MeanDisplacementOfALinearFieldIsItsValueAtTheCentre) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({2.0, 3.0, 4.0}, 2, 2, 2));
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        Vec3(x.x(), 2.0 * x.y() + x.z(), 0.0);
  }
  EXPECT_NEAR(mean_displacement(mesh, "x1", {0.0, 7.0, 0.0}, u), 5.0,
              5.0 * kRounding);
}

TEST(Loads, MassUsesTheDensityOfEachRegion) {
  TetMesh mesh = shapes::brick({2.0, 1.0, 1.0}, 2, 1, 1);
  for (int e = 0; e < mesh.element_count(); ++e) {
    mesh.element_region[e] = e < mesh.element_count() / 2 ? 0 : 1;
  }
  Material light = parts::steel();
  light.density = 2.0;
  Material heavy = light;
  heavy.density = 3.0;
  EXPECT_NEAR(mesh_mass(mesh, {light, heavy}), 5.0, kRounding * 5.0);
}

TEST(Loads, WrongNamesAndNumbersAreRefused) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THAT([&] { surface_weights(mesh, "lid"); },
              testing::ThrowsMessage<InvalidInput>(testing::AllOf(
                  testing::HasSubstr("lid"), testing::HasSubstr("x0, x1"))));
  LoadCase bad = parts::pulled({NAN, 0.0, 0.0});
  EXPECT_THROW(nodal_forces(mesh, bad), InvalidInput);
  const VectorX u = VectorX::Zero(24);
  EXPECT_THROW(mean_displacement(mesh, "x0", Vec3::Zero(), u), InvalidInput);
  EXPECT_THROW(mean_displacement(mesh, "x0", Vec3::UnitX(), u.head(3)),
               InvalidInput);
}

TEST(Loads, SurfaceWithoutAreaIsRefusedByName) {
  TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  for (Vec3& x : mesh.nodes) {
    x.y() = 0.0;
  }
  EXPECT_THAT([&] { surface_weights(mesh, "x1"); },
              testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("x1")));
}

}  // namespace
}  // namespace meniscus
