#include "fea/stress/stress_uniformity.h"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/stress/exclusion_zones.h"
#include "tests/support/parts.h"

namespace meniscus::stress_uniformity_test {
namespace {

constexpr double kRounding = 1e-12;

TEST(Uniformity, OfOneValueIsPerfect) {
  const stress::Uniformity u =
      stress::uniformity({3.0, 3.0, 3.0}, {0.1, 2.0, 0.7});
  EXPECT_DOUBLE_EQ(u.mean, 3.0);
  EXPECT_NEAR(u.coefficient_of_variation, 0.0, kRounding);
  EXPECT_NEAR(u.gini, 0.0, kRounding);
  EXPECT_EQ(u.p95_over_p50, 1.0);
  EXPECT_NEAR(u.peak_over_mean, 1.0, kRounding);
  EXPECT_NEAR(u.histogram.back(), 1.0, kRounding);
}

TEST(Uniformity, OfTwoValuesHasClosedForms) {
  // Volume 3 at value 1, volume 1 at value 5: mean 2, deviation sqrt 3, Gini
  // = share of the large in the total minus its share of the volume.
  const stress::Uniformity u =
      stress::uniformity({5.0, 1.0, 1.0}, {1.0, 2.0, 1.0});
  EXPECT_DOUBLE_EQ(u.volume, 4.0);
  EXPECT_DOUBLE_EQ(u.mean, 2.0);
  EXPECT_NEAR(u.coefficient_of_variation, std::sqrt(3.0) / 2.0, kRounding);
  EXPECT_NEAR(u.gini, 5.0 / 8.0 - 0.25, kRounding);
  EXPECT_EQ(u.p50, 1.0);
  EXPECT_EQ(u.p95, 5.0);
  EXPECT_DOUBLE_EQ(u.peak_over_mean, 2.5);
  EXPECT_NEAR(std::accumulate(u.histogram.begin(), u.histogram.end(), 0.0), 1.0,
              kRounding);
}

TEST(Uniformity, OfALinearDistributionConverges) {
  // x on (0, 1): mean 1/2, deviation 1/sqrt 12, Gini 1/3.
  constexpr int kCount = 1000;
  std::vector<double> values;
  for (int i = 0; i < kCount; ++i) {
    values.push_back((i + 0.5) / kCount);
  }
  const stress::Uniformity u =
      stress::uniformity(values, std::vector<double>(kCount, 1.0 / kCount));
  constexpr double kStep = 1.0 / kCount;
  EXPECT_NEAR(u.coefficient_of_variation, 1.0 / std::sqrt(3.0), kStep * kStep);
  EXPECT_NEAR(u.gini, 1.0 / 3.0, kStep * kStep);
  EXPECT_NEAR(u.p05, 0.05, kStep);
  EXPECT_NEAR(u.p95_over_p50, 1.9, 5.0 * kStep);
  EXPECT_NEAR(u.peak_over_mean, 2.0, 2.0 * kStep);
  for (const double share : u.histogram) {
    EXPECT_NEAR(share, 1.0 / stress::kHistogramSteps, 2.0 * kStep);
  }
}

TEST(Uniformity, IsFreeOfScaleAndOfHowVolumesAreCut) {
  const stress::Uniformity u =
      stress::uniformity({1.0, 2.0, 7.0}, {1.0, 2.0, 0.5});
  const stress::Uniformity v =
      stress::uniformity({70.0, 10.0, 20.0, 20.0}, {0.25, 0.5, 0.4, 0.6});
  EXPECT_NEAR(u.gini, v.gini, kRounding);
  EXPECT_NEAR(u.coefficient_of_variation, v.coefficient_of_variation,
              kRounding);
  EXPECT_NEAR(u.peak_over_mean, v.peak_over_mean, kRounding);
}

TEST(Uniformity, OfNothingIsRefusedAndOfNoStressIsEven) {
  EXPECT_THROW(stress::uniformity({}, {}), InvalidInput);
  EXPECT_THROW(stress::uniformity({1.0}, {0.0}), InvalidInput);
  EXPECT_THROW(stress::uniformity({-1.0}, {1.0}), InvalidInput);
  EXPECT_THROW(
      stress::uniformity({std::numeric_limits<double>::quiet_NaN()}, {1.0}),
      InvalidInput);
  EXPECT_EQ(stress::uniformity({0.0, 0.0}, {1.0, 1.0}).gini, 0.0);
}

/// Stress sxx = factor x height above the middle in a beam.
element::PointStress bent(const TetMesh& mesh, double middle) {
  element::PointStress points = element::point_stress(
      mesh, {parts::steel()},
      VectorX::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size())));
  for (std::size_t q = 0; q < points.stress.size(); ++q) {
    points.stress[q] = {};
    points.stress[q][0] = 10.0 * (points.position[q].z() - middle);
  }
  return points;
}

TEST(StressUniformity, OfAUniformBarIsPerfect) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 1.0, 1.0}, 4, 2, 2));
  loads::LoadCase pull;
  pull.name = "pull";
  pull.supports = {{"x0", true, false, false},
                   {"y0", false, true, false},
                   {"z0", false, false, true}};
  pull.forces = {{"x1", {5.0, 0.0, 0.0}}};
  const elastic::ElasticModel model(mesh, {parts::steel()}, {pull});
  const stress::StressUniformity u = stress::stress_uniformity(
      mesh, {parts::steel()},
      element::point_stress(mesh, {parts::steel()},
                            model.base_solution().displacements[0]));
  constexpr double kSolver = 1e-7;
  EXPECT_NEAR(u.von_mises.mean, 5.0, kSolver);
  EXPECT_NEAR(u.von_mises.gini, 0.0, kSolver);
  EXPECT_NEAR(u.von_mises.coefficient_of_variation, 0.0, kSolver);
  EXPECT_NEAR(u.von_mises.peak_over_mean, 1.0, kSolver);
  EXPECT_NEAR(u.energy_density.mean,
              25.0 / (2.0 * parts::steel().youngs_modulus), kSolver);
  EXPECT_NEAR(u.energy_density.gini, 0.0, kSolver);
}

TEST(StressUniformity, OfABentBeamConvergesToItsClosedForm) {
  // |z| on (-1, 1): CV 1/sqrt 3, Gini 1/3. z^2: CV 2/sqrt 5, Gini 1/2.
  double last = 0.0;
  for (const int n : {4, 8}) {
    const TetMesh mesh =
        shapes::straight_quadratic(shapes::brick({4.0, 1.0, 2.0}, n, 2, n));
    const stress::StressUniformity u =
        stress::stress_uniformity(mesh, {parts::steel()}, bent(mesh, 1.0));
    EXPECT_NEAR(u.von_mises.coefficient_of_variation, 1.0 / std::sqrt(3.0),
                1e-10);  // four points integrate squares exactly
    const double error = std::abs(u.von_mises.gini - 1.0 / 3.0) +
                         std::abs(u.energy_density.gini - 0.5) +
                         std::abs(u.energy_density.coefficient_of_variation -
                                  2.0 / std::sqrt(5.0));
    if (n == 8) {
      EXPECT_LT(error, 0.01);
      EXPECT_GT(last / error, 3.0);  // second order
    }
    last = error;
  }
}

TEST(StressUniformity, LeavesOutExclusionZones) {
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick({4.0, 1.0, 2.0}, 8, 2, 4));
  element::PointStress points = bent(mesh, -10.0);
  for (std::size_t q = 0; q < points.stress.size(); ++q) {
    points.stress[q][0] = points.position[q].x() < 1.0 ? 500.0 : 10.0;
  }
  const auto by_surface =
      stress::excluded_by(mesh, {{.surface = "x0", .distance = 1.2}}).element;
  stress::ExclusionZone box;
  box.box = {{-1.0, -1.0, -1.0}, {1.0, 9.0, 9.0}};
  const auto by_box = stress::excluded_by(mesh, {box}).element;
  for (const auto& excluded : {by_surface, by_box}) {
    const stress::StressUniformity u =
        stress::stress_uniformity(mesh, {parts::steel()}, points, excluded);
    EXPECT_EQ(u.von_mises.peak, 10.0);
  }
  EXPECT_NEAR(stress::stress_uniformity(mesh, {parts::steel()}, points, by_box)
                  .von_mises.volume,
              6.0, 1e-12);
  EXPECT_GT(
      stress::stress_uniformity(mesh, {parts::steel()}, points).von_mises.gini,
      0.5);
}

TEST(StressUniformity, WrongZonesAreRefused) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  stress::ExclusionZone flat;
  flat.box = {{0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}};
  for (const stress::ExclusionZone& zone :
       {stress::ExclusionZone{},
        stress::ExclusionZone{.surface = "nose", .distance = 1.0},
        stress::ExclusionZone{.surface = "x0"}, flat}) {
    EXPECT_THROW(stress::excluded_by(mesh, {zone}), InvalidInput);
  }
  const std::vector<char> all(6, 1);
  EXPECT_THROW(
      stress::stress_uniformity(
          mesh, {parts::steel()},
          element::point_stress(mesh, {parts::steel()}, VectorX::Zero(24)),
          all),
      InvalidInput);
}

}  // namespace
}  // namespace meniscus::stress_uniformity_test
