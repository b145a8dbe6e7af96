/// Films that other programs' scripts fail on: the finest mesh at once, kinked
/// and without any step before, from one default call.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/delaunay_curves.h"
#include "tests/support/film_complexes.h"
#include "tests/support/more.h"
#include "tests/verification/film_cases.h"

namespace meniscus::film_robustness_test {
namespace {

using test_films::Found;

// Relative error of energy and pressure x facets: 0.2 on the catenoid, 2.4 on
// the cube that became a sphere, 13 in the pressure of the flattest cap, whose
// facets the cube's sides leave long.
constexpr double kFaceting = 16.0;

/// One find_equilibrium() with default options on `start` refined `times`
/// times before the engine sees it: no level, scale or tolerance is given.
Found found_raw(films::FilmComplex start, int times) {
  Found found{test_films::raw_fine(std::move(start), times), {}};
  found.state = settle::find_equilibrium(found.complex, {});
  const settle::FilmReport& report = found.report();
  EXPECT_FALSE(found.state.failure);
  EXPECT_EQ(report.verdict, "stable");
  EXPECT_EQ(report.index, 0);
  EXPECT_GT(report.min_eigenvalue, 0.0);
  EXPECT_LE(report.residual, report.residual_bound);
  for (const settle::BodyState& body : report.bodies) {
    EXPECT_NEAR(body.volume, body.target_volume, 1e-9 * body.target_volume);
  }
  return found;
}

void expect_energy(const Found& found, double exact) {
  const double facets = found.report().facets;
  EXPECT_NEAR(found.report().energy, exact, kFaceting / facets * exact);
}

void expect_pressure(const Found& found, double exact) {
  const double facets = found.report().facets;
  for (const settle::BodyState& body : found.report().bodies) {
    EXPECT_NEAR(body.pressure, exact, kFaceting / facets * exact);
  }
}

TEST(FilmRobustness, Cylinder) {
  const Found found = found_raw(test_films::catenoid_start(), more_or(6, 5));
  EXPECT_EQ(found.report().facets, more_or(245760, 61440));
  expect_energy(found, test_films::catenoid(1.0, 1.0).area);
}

TEST(FilmRobustness, Cube) {
  const test_films::Sphere exact = test_films::sphere_of_volume(1.0);
  const Found found = found_raw(test_films::cube_start(), more_or(5, 4));
  EXPECT_EQ(found.report().facets, more_or(221184, 55296));
  expect_energy(found, exact.area);
  expect_pressure(found, exact.pressure);
}

// No closed form: the groomed film of as many facets differs by its faceting.
TEST(FilmRobustness, Strut) {
  const Found found = found_raw(test_films::strut_start(), 3);
  const Found nested = test_films::settled(test_films::strut_start(), 3);
  EXPECT_GE(found.report().facets, 15360);
  expect_energy(found, nested.report().energy);
  expect_pressure(found, nested.pressure());
}

TEST(FilmRobustness, SessileCaps) {
  for (const double degrees : {50.0, 90.0, 150.0}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * std::numbers::pi / 180.0;
    const test_films::SessileCap exact = test_films::sessile_cap(1.0, angle);
    const Found found = found_raw(test_films::sessile_cap_start(angle), 4);
    expect_energy(found, exact.energy);
    expect_pressure(found, exact.pressure);
  }
}

TEST(FilmRobustness, DoubleBubble) {
  const test_films::DoubleBubble exact = test_films::double_bubble(1.0);
  const Found found = found_raw(test_films::double_bubble_start(), 4);
  expect_energy(found, exact.area);
  expect_pressure(found, exact.pressure);
}

TEST(FilmRobustness, TripleDisk) {
  const Found found = found_raw(test_films::triple_disk_start(), 4);
  expect_energy(found, test_films::triple_disk().area);
}

// Places where lines meet have to move by many edges.
TEST(FilmRobustness, Frames) {
  const Found cube = found_raw(test_films::cube_frame_start(), 4);
  expect_energy(cube, test_films::kCubeFrameArea);
  const Found tetrahedron = found_raw(test_films::tetrahedral_frame_start(), 4);
  expect_energy(tetrahedron, test_films::kTetrahedralFrameArea);
}

}  // namespace
}  // namespace meniscus::film_robustness_test
