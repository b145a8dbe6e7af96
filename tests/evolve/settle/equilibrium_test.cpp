#include "evolve/settle/equilibrium.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evolve/groom/flip_average.h"
#include "evolve/settle/curvature_flow.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_shapes.h"

namespace meniscus::equilibrium_test {
namespace {

settle::FilmState settle_normals(const films::FilmComplex& complex) {
  const energy::FilmEnergy energy(complex);
  return settle::settle_in_normals(energy, complex, energy::targets_of(complex),
                                   complex.mesh.points, {});
}

double catenoid_error(int n) {
  const films::FilmComplex complex =
      shapes::tube(1.0, 1.0, n, n / 4, [](double) { return 1.0; });
  const settle::FilmState state = settle_normals(complex);
  EXPECT_FALSE(state.failure) << state.report.verdict;
  EXPECT_LE(state.report.residual, state.report.residual_bound);
  EXPECT_EQ(state.report.index, 0);
  EXPECT_NEAR(state.report.smallest_neck, 2 * 0.848338, 0.02);
  return state.report.area - 5.99179697580228;  // reference.md
}

TEST(Equilibrium, CatenoidAtSecondOrder) {
  const double coarse = catenoid_error(32);
  const double fine = catenoid_error(64);
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2.0, 0.2);
}

settle::FilmState catenoid_from_flow(double spacing) {
  films::FilmComplex complex =
      shapes::tube(1.0, spacing, 48, 14, [](double) { return 1.0; });
  settle::flow_to_rest(complex, {});
  return settle_normals(complex);
}

// The limit is 1.32548 (reference.md).
TEST(Equilibrium, CatenoidExistsUpToItsLimit) {
  const settle::FilmState inside = catenoid_from_flow(1.31);
  EXPECT_FALSE(inside.failure) << inside.report.verdict;
  const settle::FilmState beyond = catenoid_from_flow(1.34);
  ASSERT_TRUE(beyond.failure);
  EXPECT_THAT(beyond.report.verdict,
              testing::AnyOf(testing::HasSubstr("no equilibrium"),
                             testing::HasSubstr("pinching")));
  EXPECT_NEAR(beyond.report.neck_position.norm(), 0.0, 0.1);
}

double sphere_error(int levels) {
  SurfaceMesh mesh = shapes::sphere(1.0, levels);
  for (Vec3& p : mesh.points) {
    p = p.cwiseProduct(Vec3(0.7, 0.6, 0.5));
  }
  const settle::FilmState state = settle_normals(shapes::drop(mesh, 1.0));
  EXPECT_FALSE(state.failure) << state.report.verdict;
  EXPECT_NEAR(state.report.bodies[0].volume, 1.0, 1e-10);
  // Young-Laplace: 2 T / R.
  EXPECT_NEAR(state.report.bodies[0].pressure, 2 / 0.620350490899, 0.05);
  return state.report.area - 4.83597586204941;
}

TEST(Equilibrium, EllipsoidBecomesASphereAtSecondOrder) {
  const double coarse = sphere_error(3);
  const double fine = sphere_error(4);
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 2.0, 0.2);
}

// From twice the volume and from half of it, edges and corners included.
TEST(Equilibrium, CubeFlowsToASphere) {
  for (const double volume : {0.5, 1.0, 2.0}) {
    films::FilmComplex complex =
        shapes::drop(shapes::box(Vec3(1, 1, 1), 8), volume);
    settle::flow_to_rest(complex, {});
    const settle::FilmState state = settle_normals(complex);
    EXPECT_FALSE(state.failure) << state.report.verdict;
    const double exact = std::cbrt(36.0 * std::numbers::pi * volume * volume);
    EXPECT_NEAR(state.report.area, exact, 0.02 * exact);
  }
}

settle::FilmState cylinder(double length, bool by_volume) {
  const int n = 64;  // the inscribed polygon asks for 0.2 % less pressure
  const auto m = static_cast<int>(std::lround(length * n / 6.28));
  films::FilmComplex complex =
      shapes::tube(1.0, length, n, m, [](double) { return 1.0; });
  shapes::close_tube(complex, n);
  if (by_volume) {
    complex.bodies[0].volume = enclosed_volume(complex.mesh);
  } else {
    complex.bodies[0].pressure = 1.0;
  }
  return settle_normals(complex);
}

TEST(Equilibrium, CylinderAtFixedPressureIsStableBelowPi) {
  const settle::FilmState shorter = cylinder(3.0, false);
  EXPECT_FALSE(shorter.failure) << shorter.report.verdict;
  EXPECT_EQ(shorter.report.index, 0);
  const settle::FilmState longer = cylinder(3.3, false);
  ASSERT_TRUE(longer.failure);
  EXPECT_EQ(longer.failure->kind, FailureKind::FilmUnstable)
      << longer.report.verdict;
  EXPECT_EQ(longer.report.index, 1);
  EXPECT_LT(longer.report.min_eigenvalue, 0.0);
}

TEST(Equilibrium, CylinderAtFixedVolumeIsStableBelowTwoPi) {
  const settle::FilmState shorter = cylinder(6.1, true);
  EXPECT_FALSE(shorter.failure) << shorter.report.verdict;
  const settle::FilmState longer = cylinder(6.5, true);
  ASSERT_TRUE(longer.failure);
  EXPECT_EQ(longer.failure->kind, FailureKind::FilmUnstable)
      << longer.report.verdict;
  EXPECT_EQ(longer.report.index, 1);
}

// At the square's corners the film turns by three quarters of a circle within a
// facet or two: few facets fold there, and each refinement of them again.
TEST(Equilibrium, ARawStrutSettlesOnItsRefinements) {
  constexpr double kEnergy = 26.890;  // at 786,000 facets, to a digit
  double before = 0.0;
  for (const int refinements : {3, 4, 5}) {
    films::FilmComplex strut = test_films::strut_start(12, 3);
    groom::equiangulate(strut, groom::FlipRule::AnglesOnly);
    const settle::FilmState state =
        settle::find_equilibrium(strut, {.refinements = refinements});
    EXPECT_EQ(state.report.verdict, "stable") << refinements;
    const double above = state.report.energy - kEnergy;
    EXPECT_GT(above, 0.0);
    if (before > 0.0) {
      EXPECT_LT(above, 0.4 * before) << refinements;  // a quarter, and corners
    }
    before = above;
  }
}

// Gravity on bodies without weight moves nothing: the bubble floats still, and
// its lowest mode is that of a sphere, 4 T / R^2.
TEST(Equilibrium, AnIndexThatWasNotCountedIsAtLeastThat) {
  settle::FilmReport film;
  film.index = 1;
  EXPECT_EQ(settle::index_text(film), "1");
  film.index_at_least = true;
  EXPECT_EQ(settle::index_text(film), "at least 1");
}

TEST(Equilibrium, GravityWithoutWeightHoldsNothing) {
  films::FilmComplex bubble = test_films::cube_start();
  bubble.gravity = Vec3(0, 0, -9.81);
  const settle::FilmState state =
      settle::find_equilibrium(bubble, {.refinements = 1});
  EXPECT_EQ(state.report.verdict, "stable");
  const double radius = std::cbrt(0.75 / std::numbers::pi);
  EXPECT_NEAR(state.report.min_eigenvalue, 4.0 / (radius * radius), 0.3);
}

}  // namespace
}  // namespace meniscus::equilibrium_test
