#include "fea/stress/size_field.h"

#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/element/point_grid.h"
#include "tests/support/parts.h"

namespace meniscus::size_field_test {
namespace {

constexpr double kSizeRounding = 1e-9;

TEST(PointGrid, AgreesWithLookingAtAll) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Vec3& size : {Vec3(1, 1, 1), Vec3(5, 1, 0.01), Vec3(1, 0, 0)}) {
    Points points;
    for (int i = 0; i < 300; ++i) {
      points.push_back(
          size.cwiseProduct(Vec3(unit(random), unit(random), unit(random))));
    }
    const element::PointGrid nearest(points);
    for (int k = 0; k < 200; ++k) {
      const Vec3 x =
          3.0 * Vec3(unit(random), unit(random), unit(random)) - Vec3::Ones();
      double least = 1e300;
      for (const Vec3& p : points) {
        least = std::min(least, (p - x).norm());
      }
      EXPECT_EQ((points[nearest.of(x)] - x).norm(), least);
    }
  }
  EXPECT_EQ(element::PointGrid({Vec3(1, 2, 3), Vec3(1, 2, 3)}).of({9, 9, 9}),
            0);
}

/// Errors of a unit cube's elements as `density` (error^2 per volume) has it.
template <class Density>
stress::EnergyError errors(const TetMesh& mesh, const Density& density) {
  stress::EnergyError error;
  error.energy_norm = 1.0;
  double squares = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (const int i : mesh.element(e).first<4>()) {
      centre += 0.25 * mesh.nodes[i];
    }
    const double square = density(centre) * corner_volume(mesh, e);
    error.element.push_back(std::sqrt(square));
    squares += square;
  }
  error.error = std::sqrt(squares);
  return error;
}

class Sizes : public testing::TestWithParam<int> {
 protected:
  static TetMesh cube(int n) {
    const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, n, n, n);
    return GetParam() == 2 ? shapes::straight_quadratic(mesh) : mesh;
  }
};

TEST_P(Sizes, OfEvenErrorsAreEvenAndReachTheTarget) {
  const int p = GetParam();
  const TetMesh mesh = cube(6);
  const stress::EnergyError error =
      errors(mesh, [](const Vec3&) { return 0.01; });
  // The order p means: the error over 2^p wants edges halved.
  const double target = error.relative() / std::pow(2.0, p);
  const stress::SizeField field = stress::size_field(
      mesh, error, {.relative_error = target, .growth = 1e6});
  const double longest =
      *std::max_element(field.length.begin(), field.length.end());
  const double shortest =
      *std::min_element(field.length.begin(), field.length.end());
  EXPECT_NEAR(longest, shortest, 1e-6);
  EXPECT_NEAR(field.elements, 8.0 * mesh.element_count(),
              1e-6 * mesh.element_count());
  EXPECT_NEAR(field.error / std::hypot(1.0, error.error), target,
              1e-6 * target);
}

TEST_P(Sizes, AreFineWhereTheErrorIsAndGrowGently) {
  const TetMesh mesh = cube(8);
  const stress::EnergyError error = errors(
      mesh, [](const Vec3& x) { return std::exp(-40.0 * x.squaredNorm()); });
  constexpr double kGrowth = 0.4;
  const stress::SizeField field = stress::size_field(
      mesh, error,
      {.relative_error = 0.3 * error.relative(), .growth = kGrowth});
  const auto h = field.function();
  EXPECT_LT(h({0.0, 0.0, 0.0}), 0.6 * h({1.0, 1.0, 1.0}));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto ids = mesh.element(e);
    for (const auto& [a, b] : kTetEdges) {
      const double step = (mesh.nodes[ids[a]] - mesh.nodes[ids[b]]).norm();
      EXPECT_LE(std::abs(field.length[ids[a]] - field.length[ids[b]]),
                kGrowth * step + kSizeRounding);
    }
  }
  for (std::size_t i = 0; i < field.points.size(); ++i) {
    EXPECT_EQ(h(field.points[i]), field.length[i]);
  }
}

TEST_P(Sizes, StayWithinTheBoundsAndTellWhatTheyMiss) {
  const TetMesh mesh = cube(4);
  const stress::EnergyError error =
      errors(mesh, [](const Vec3&) { return 0.01; });
  const stress::SizeField fine = stress::size_field(
      mesh, error,
      {.relative_error = 1e-9, .most_refinement = 3.0, .growth = 1e6});
  EXPECT_NEAR(fine.elements, 27.0 * mesh.element_count(), 1e-6);
  EXPECT_GT(fine.error, 1e-9);
  const stress::SizeField coarse = stress::size_field(
      mesh, error,
      {.relative_error = 0.99, .most_coarsening = 2.0, .growth = 1e6});
  EXPECT_NEAR(coarse.elements, mesh.element_count() / 8.0, 1e-6);
}

TEST_P(Sizes, RefuseOptionsOutOfRange) {
  const TetMesh mesh = cube(1);
  const stress::EnergyError error =
      errors(mesh, [](const Vec3&) { return 0.01; });
  EXPECT_THROW(stress::size_field(mesh, error, {.relative_error = 0.0}),
               InvalidInput);
  EXPECT_THROW(stress::size_field(mesh, error, {.most_refinement = 0.5}),
               InvalidInput);
  EXPECT_THROW(stress::size_field(mesh, error, {.most_coarsening = 0.5}),
               InvalidInput);
  EXPECT_THROW(stress::size_field(mesh, error, {.growth = 0.0}), InvalidInput);
  EXPECT_THROW(stress::size_field(mesh, stress::EnergyError{}, {}),
               InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, Sizes, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::size_field_test
