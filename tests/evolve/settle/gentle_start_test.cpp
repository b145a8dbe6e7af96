#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "evolve/settle/bring_near_gently.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_complexes.h"

namespace meniscus::gentle_start_test {
namespace {

// The error of chords, on the finest facets here.
constexpr double kArea = 5e-3;

/// A tube of radius 1 between rings that are `length` apart, without pressure,
/// its free vertices drawn in to `waist` about half its height.
films::FilmComplex drawn_in(double length, double waist) {
  films::FilmComplex complex =
      test_films::tube_start({.length = length, .around = 12, .rows = 4});
  complex.bodies[0].pressure = 0.0;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].kind == films::VertexKind::Free) {
      Vec3& p = complex.mesh.points[v];
      const double off = 2.0 * p.z() / length - 1.0;
      const double radius = waist + (1.0 - waist) * off * off;
      p = Vec3(radius * p.x(), radius * p.y(), p.z());
    }
  }
  return complex;
}

/// Of the wider catenoid between rings of radius 1.
double catenoid_area(double length) {
  double waist = 1.0;
  for (int k = 0; k < 200; ++k) {
    waist = 1.0 / std::cosh(0.5 * length / waist);
  }
  return std::numbers::pi * waist *
         (length + waist * std::sinh(length / waist));
}

// Thinner than the unstable catenoid, 0.235 at its waist: the start shrinks
// away from the stable one.
TEST(GentleStart, FindsTheFilmOutsideAThinStart) {
  for (const double waist : {0.05, 0.1, 0.15}) {
    films::FilmComplex complex = drawn_in(1.0, waist);
    const settle::FilmState found =
        settle::find_equilibrium(complex, {.refinements = 2});
    ASSERT_FALSE(found.failure) << waist << ": " << found.report.verdict;
    EXPECT_NEAR(found.report.area, catenoid_area(1.0),
                kArea * catenoid_area(1.0))
        << waist;
  }
}

// Further apart than 1.325 there is none.
TEST(GentleStart, FindsNoneWhereThereIsNone) {
  for (const double waist : {0.1, 0.9}) {
    films::FilmComplex complex = drawn_in(1.5, waist);
    const settle::FilmState found =
        settle::find_equilibrium(complex, {.refinements = 2});
    ASSERT_TRUE(found.failure) << waist;
    EXPECT_EQ(found.failure->kind, FailureKind::FilmPinched)
        << found.report.verdict;
  }
}

TEST(GentleStart, LeavesBodiesAsTheyWereAsked) {
  films::FilmComplex complex = drawn_in(1.0, 0.1);
  int steps = 0;
  const int left =
      settle::bring_near_gently(complex, {.refinements = 5}, steps);
  EXPECT_GT(steps, 0);
  EXPECT_FALSE(complex.bodies[0].volume);
  EXPECT_EQ(complex.bodies[0].pressure, 0.0);
  EXPECT_EQ(left, 4);  // 480 facets; twice refined they would be 1920
  EXPECT_EQ(complex.mesh.facets.size(), 480U);
}

}  // namespace
}  // namespace meniscus::gentle_start_test
