#include "fea/stress/patch_recovery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <omp.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/parts.h"

namespace meniscus::patch_recovery_test {
namespace {

// Least squares with ten terms lose some digits.
constexpr double kFit = 1e-10;

/// Stresses that are polynomials of degree 1 or 2 of the place.
element::Stress polynomial(const Vec3& x, int degree, double scale = 1.0) {
  element::Stress s;
  for (int k = 0; k < 6; ++k) {
    s[k] = 1.0 + k + 0.5 * x.x() - 0.3 * k * x.y() + 0.7 * x.z();
    if (degree == 2) {
      s[k] +=
          0.4 * x.x() * x.x() - 0.2 * k * x.y() * x.z() + 0.1 * x.z() * x.x();
    }
    s[k] *= scale;
  }
  return s;
}

TetMesh brick_of(int order, const Vec3& size, int nx, int ny, int nz) {
  const TetMesh mesh = shapes::brick(size, nx, ny, nz);
  return order == 2 ? shapes::straight_quadratic(mesh) : mesh;
}

element::PointStress zero_stress(const TetMesh& mesh) {
  return element::point_stress(
      mesh, {parts::steel(), parts::steel()},
      VectorX::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size())));
}

element::PointStress sampled(const TetMesh& mesh, int degree) {
  element::PointStress points = zero_stress(mesh);
  for (std::size_t q = 0; q < points.stress.size(); ++q) {
    points.stress[q] = polynomial(points.position[q], degree);
  }
  return points;
}

void expect_near(const element::Stress& found, const element::Stress& exact,
                 const Vec3& x) {
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(found[k], exact[k], kFit * 10.0) << x.transpose();
  }
}

class PatchRecovery : public testing::TestWithParam<int> {};

TEST_P(PatchRecovery, BringsBackPolynomialsOfTheElementsOrderEverywhere) {
  const int order = GetParam();
  TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, 4);
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
  }
  const stress::RecoveredStress found =
      stress::recover_by_patches(mesh, sampled(mesh, order));
  ASSERT_EQ(found.value.size(), mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    expect_near(found.value[i], polynomial(mesh.nodes[i], order),
                mesh.nodes[i]);
  }
}

TEST_P(PatchRecovery, KeepsTheJumpWhereMaterialsMeet) {
  const int order = GetParam();
  TetMesh mesh = brick_of(order, {2.0, 1.0, 1.0}, 8, 4, 4);
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (int c = 0; c < 4; ++c) {
      centre += 0.25 * mesh.nodes[mesh.element(e)[c]];
    }
    mesh.element_region[e] = centre.x() < 1.0 ? 0 : 1;
  }
  element::PointStress points = sampled(mesh, order);
  for (std::size_t q = 0; q < points.stress.size(); ++q) {
    if (points.position[q].x() > 1.0) {
      points.stress[q] = polynomial(points.position[q], order, -3.0);
    }
  }
  const stress::RecoveredStress found =
      stress::recover_by_patches(mesh, points);
  EXPECT_GT(found.value.size(), mesh.nodes.size());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const double scale = mesh.element_region[e] == 0 ? 1.0 : -3.0;
    for (const int copy : found.nodes.element(e)) {
      const Vec3& x = mesh.nodes[found.nodes.node[copy]];
      expect_near(found.value[copy], polynomial(x, order, scale), x);
    }
  }
  // One value a node: the harder stressed side's.
  const stress::StressField nodal = stress::nodal_stress(mesh, found);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    expect_near(nodal.nodal[i], polynomial(x, order, x.x() < 0.99 ? 1.0 : -3.0),
                x);
  }
}

TEST_P(PatchRecovery, ServesWallsOneElementThickAndSingleElements) {
  const int order = GetParam();
  for (const TetMesh& mesh : {brick_of(order, {4.0, 4.0, 0.3}, 4, 4, 1),
                              brick_of(order, {1.0, 1.0, 1.0}, 1, 1, 1)}) {
    const stress::RecoveredStress found =
        stress::recover_by_patches(mesh, sampled(mesh, 1));
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      if (order == 2) {  // linear stress from few elements of four points
        expect_near(found.value[i], polynomial(mesh.nodes[i], 1),
                    mesh.nodes[i]);
      }
      for (const double s : found.value[i]) {
        EXPECT_TRUE(std::isfinite(s));
      }
    }
  }
}

TEST_P(PatchRecovery, HasTheSameBitsOnOneAndTwoThreads) {
  const TetMesh mesh = brick_of(GetParam(), {1.0, 2.0, 1.5}, 5, 4, 6);
  const element::PointStress points = sampled(mesh, 2);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const stress::RecoveredStress one = stress::recover_by_patches(mesh, points);
  omp_set_num_threads(2);
  const stress::RecoveredStress two = stress::recover_by_patches(mesh, points);
  omp_set_num_threads(before);
  EXPECT_EQ(one.value, two.value);
}

TEST_P(PatchRecovery, KnowsTheCornersThatElementsSurround) {
  const TetMesh mesh = brick_of(GetParam(), {1.0, 2.0, 1.5}, 5, 4, 6);
  const std::vector<char> inner =
      element::surrounded_corners(element::region_nodes(mesh));
  EXPECT_EQ(std::accumulate(inner.begin(), inner.end(), 0), 4 * 3 * 5);
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (inner[i] != 0) {
      const Vec3& x = mesh.nodes[i];
      EXPECT_TRUE(x.minCoeff() > 0.0 && x.x() < 1.0 && x.y() < 2.0 &&
                  x.z() < 1.5);
    }
  }
}

TEST_P(PatchRecovery, SurvivesElementsWithoutSizeAndStressesThatAreNoNumbers) {
  const TetMesh mesh = brick_of(GetParam(), {1.0, 1.0, 1.0}, 2, 2, 2);
  element::PointStress points = sampled(mesh, 1);
  for (Vec3& x : points.position) {
    x.setConstant(0.5);  // all in one place
  }
  const stress::RecoveredStress flat = stress::recover_by_patches(mesh, points);
  for (const element::Stress& s : flat.value) {
    EXPECT_TRUE(std::isfinite(element::von_mises(s)));
  }
  points = sampled(mesh, 1);
  points.stress[0][0] = std::numeric_limits<double>::quiet_NaN();
  const stress::RecoveredStress lost = stress::recover_by_patches(mesh, points);
  EXPECT_TRUE(std::any_of(lost.value.begin(), lost.value.end(),
                          [](const element::Stress& s) {
                            return std::isnan(s[0]);
                          }));  // not hidden
}

INSTANTIATE_TEST_SUITE_P(Orders, PatchRecovery, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::patch_recovery_test
