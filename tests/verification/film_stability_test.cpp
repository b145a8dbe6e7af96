// The verdict on films of known index: stable ones on one side of a limit,
// saddles on the other, pinching where no film is left.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "evolve/groom/pop.h"
#include "evolve/settle/find_equilibrium.h"
#include "evolve/start/start_complex.h"
#include "tests/support/delaunay_curves.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_race.h"
#include "tests/support/film_systems.h"

namespace meniscus::film_stability_test {
namespace {

settle::FilmReport report_of(const films::FilmComplex& start) {
  films::FilmComplex complex = start;
  return find_refined(complex, 0).report;
}

test_films::TubeSpec tube(double length) {
  return {.length = length,
          .around = 24,
          .rows = static_cast<int>(std::lround(4.0 * length))};
}

/// Of the equilibrium that Newton's method ends at, saddles too.
settle::FilmState resting_at(const films::FilmComplex& start) {
  const energy::FilmEnergy energy(start);
  return settle::settle_in_normals(energy, start, energy::targets_of(start),
                                   start.mesh.points, {});
}

films::FilmComplex tube_at_pressure(double length) {
  test_films::TubeSpec spec = tube(length);
  spec.pressure = test_films::prism_pressure(spec);
  return test_films::tube_start(spec);
}

settle::FilmReport at_volume(double length) {
  test_films::TubeSpec spec = tube(length);
  spec.volume = test_films::prism_volume(spec);
  return report_of(test_films::tube_start(spec));
}

settle::FilmReport catenoid_between(double spacing) {
  films::FilmComplex start = test_films::catenoid_start(24, 8);
  for (curves::Curve& curve : start.curves) {
    std::get<curves::Circle>(curve.shape).center.z() *= spacing;
  }
  for (Vec3& p : start.mesh.points) {
    p.z() *= spacing;
  }
  return report_of(start);
}

// Limit pi at fixed pressure. Beyond it the prism rests as a saddle, and beside
// it lies a film of less energy at that pressure.
TEST(FilmStability, CylinderAtFixedPressure) {
  for (const double length : {2.0, 3.0}) {
    const settle::FilmReport report = report_of(tube_at_pressure(length));
    EXPECT_EQ(report.index, 0) << length;
    EXPECT_GT(report.min_eigenvalue, 0.0) << length;
    EXPECT_EQ(report.verdict, "stable") << length;
  }
  const films::FilmComplex longer = tube_at_pressure(3.3);
  const settle::FilmReport beyond = resting_at(longer).report;
  EXPECT_EQ(beyond.index, 1) << beyond.verdict;
  EXPECT_LT(beyond.min_eigenvalue, 0.0);
  const settle::FilmReport beside = report_of(longer);
  EXPECT_EQ(beside.index, 0) << beside.verdict;
  const auto enthalpy = [](const settle::FilmReport& film) {
    return film.energy - film.bodies[0].pressure * film.bodies[0].volume;
  };
  EXPECT_LT(enthalpy(beside), enthalpy(beyond));
}

// Limit 2 pi at fixed volume (Plateau, Rayleigh).
TEST(FilmStability, CylinderAtFixedVolume) {
  for (const double length : {4.0, 6.1}) {
    const settle::FilmReport report = at_volume(length);
    EXPECT_EQ(report.index, 0) << length;
    EXPECT_EQ(report.verdict, "stable") << length;
  }
  const settle::FilmReport beyond = at_volume(6.5);
  EXPECT_EQ(beyond.index, 1) << beyond.verdict;
  EXPECT_LE(beyond.residual, beyond.residual_bound) << "a settled saddle";
  EXPECT_NE(beyond.verdict.find("unstable"), std::string::npos);
}

TEST(FilmStability, SymmetricSaddles) {
  const settle::FilmReport tube = report_of(test_films::long_tube_saddle());
  EXPECT_EQ(tube.index, 1) << tube.verdict;
  const settle::FilmReport catenoid =
      resting_at(test_films::thin_catenoid_saddle()).report;
  EXPECT_EQ(catenoid.index, 1) << catenoid.verdict;
  EXPECT_NEAR(0.5 * catenoid.smallest_neck,
              test_films::thin_catenoid(1.0, 1.0).waist, 0.01);
}

// Of the two catenoids between two rings the thin one is the saddle: beside it
// lies the other, and on its other side nothing.
TEST(FilmStability, FromTheThinCatenoidToTheStableOne) {
  const settle::FilmReport film = report_of(test_films::thin_catenoid_saddle());
  EXPECT_EQ(film.verdict, "stable");
  const test_films::Catenoid stable = test_films::catenoid(1.0, 1.0);
  EXPECT_NEAR(0.5 * film.smallest_neck, stable.waist, 0.02);
  EXPECT_NEAR(film.area, stable.area, 0.02 * stable.area);
  EXPECT_LT(film.area, test_films::thin_catenoid(1.0, 1.0).area);
}

// Found at 1.31, none at 1.34 (limit 1.32548).
TEST(FilmStability, CatenoidNearItsLimit) {
  EXPECT_EQ(catenoid_between(1.31).verdict, "stable");
  const settle::FilmReport beyond = catenoid_between(1.34);
  EXPECT_NE(beyond.verdict.find("pinching"), std::string::npos)
      << beyond.verdict;
  // Both rings at +-0.67: the neck is at the middle, within 5 % of 1.34.
  EXPECT_NEAR(beyond.neck_position.z(), 0.0, 0.05 * 1.34);
}

constexpr double kStrutLength = 4.0;

settle::FilmReport strut_at(double volume, int refinements) {
  films::FilmComplex strut = test_films::strut_start();
  strut.bodies[0].volume = volume;
  return find_refined(strut, refinements).report;
}

// From V = 13 stable, at 12.5 no more: a neck pinches near the small ring,
// which is at z = 4.
TEST(FilmStability, StrutNearItsLimit) {
  for (const double volume : {14.0, 13.0}) {
    const settle::FilmReport film = strut_at(volume, 3);
    EXPECT_EQ(film.verdict, "stable") << volume;
    EXPECT_EQ(film.index, 0) << volume;
    EXPECT_GT(film.min_eigenvalue, 0.0) << volume;
  }
  // The neck's place does not depend on the volume or the mesh.
  const double neck = 3.29;
  for (const double volume : {12.5, 12.25, 12.0}) {
    for (const int refinements : {1, 3}) {
      const settle::FilmReport film = strut_at(volume, refinements);
      EXPECT_NE(film.verdict.find("pinching"), std::string::npos)
          << volume << ": " << film.verdict;
      EXPECT_NEAR(film.neck_position.z(), neck, 0.05 * kStrutLength)
          << volume << ", refinements " << refinements;
    }
  }
}

// Two opposite arms and a foot that share one volume see each other at fixed
// pressure: the limit per arm is nearer to pi R than to 2 pi R.
settle::FilmState tee(double half, double ring, double volume) {
  films::FilmSystem system;
  system.curves = {
      {"foot", curves::Circle{Vec3(0, 0, -80), Vec3(0, 0, -1), ring}},
      {"left", curves::Circle{Vec3(-half, 0, 0), Vec3(-1, 0, 0), ring}},
      {"right", curves::Circle{Vec3(half, 0, 0), Vec3(1, 0, 0), ring}}};
  system.films = {
      {"skin", films::FilmKind::Branch, {"foot", "left", "right"}, 1.0}};
  system.caps = {
      {"foot_cap", "foot"}, {"left_cap", "left"}, {"right_cap", "right"}};
  system.bodies = {{"part",
                    {"skin", "foot_cap", "left_cap", "right_cap"},
                    volume,
                    std::nullopt}};
  constexpr double kEdge = 10.0;
  films::FilmComplex start = start::build_start(system, 2.0 * kEdge);
  return settle::find_equilibrium(start, {.edge = kEdge});
}

TEST(FilmStability, TeeOfArms) {
  const settle::FilmState saddle = tee(120.0, 30.0, 9e5);
  EXPECT_EQ(saddle.report.index, 1) << saddle.report.verdict;
  EXPECT_LE(saddle.report.residual, saddle.report.residual_bound);
  ASSERT_TRUE(saddle.failure);
  EXPECT_EQ(saddle.failure->kind, FailureKind::FilmUnstable);
  const settle::FilmState stable = tee(120.0, 40.0, 1.6e6);
  EXPECT_EQ(stable.report.verdict, "stable");
  for (const double ring : {25.0, 30.0}) {
    const settle::FilmState gone = tee(150.0, ring, ring < 30.0 ? 8e5 : 1.1e6);
    ASSERT_TRUE(gone.failure) << ring;
    EXPECT_EQ(gone.failure->kind, FailureKind::FilmPinched)
        << gone.failure->message;
    // In an arm, between the tee's middle and the rim.
    const Vec3& at = gone.report.neck_position;
    EXPECT_GT(std::abs(at.x()), 60.0);
    EXPECT_LT(std::abs(at.x()), 140.0);
  }
}

// A pressure that no film can hold: said soon, in little memory.
TEST(FilmStability, PressureBeyondEveryFilm) {
  films::FilmSystem system = systems::two_arm(0.0);
  system.bodies[0].volume.reset();
  system.bodies[0].pressure = 0.6;
  constexpr double kEdge = 16.0;
  films::FilmComplex start = start::build_start(system, kEdge);
  const settle::FilmState gone =
      settle::find_equilibrium(start, {.edge = kEdge});
  ASSERT_TRUE(gone.failure);
  EXPECT_EQ(gone.failure->kind, FailureKind::FilmNotFound);
  EXPECT_NE(gone.failure->message.find("grows without end"), std::string::npos)
      << gone.failure->message;
  constexpr std::size_t kMany = 200'000;
  EXPECT_LT(start.mesh.facets.size(), kMany);
}

// The two-arm bracket far out: 1.60e6 mm3 is enough at support_x = 40, and at
// 1.55e6 the long arm's neck goes, though Newton's method can end there at a
// perfect residual and a positive definite Hessian.
TEST(FilmStability, TwoArmBracketFarOut) {
  const auto find = [](double support_x, double volume) {
    constexpr double kEdge = 8.0;
    films::FilmComplex start =
        start::build_start(systems::two_arm(support_x, volume), 2.0 * kEdge);
    return settle::find_equilibrium(start, {.edge = kEdge});
  };
  EXPECT_EQ(find(0.0, 1.20e6).report.verdict, "stable");
  EXPECT_EQ(find(40.0, 1.60e6).report.verdict, "stable");
  EXPECT_EQ(find(60.0, 1.65e6).report.verdict, "stable");
  for (const double support_x : {40.0, 60.0}) {
    const settle::FilmState gone =
        find(support_x, support_x < 50.0 ? 1.55e6 : 1.60e6);
    ASSERT_TRUE(gone.failure) << support_x;
    EXPECT_EQ(gone.failure->kind, FailureKind::FilmPinched)
        << gone.failure->message;
    // In the long arm, which reaches to x = -120.
    EXPECT_LT(gone.report.neck_position.x(), -20.0) << support_x;
    EXPECT_GT(gone.report.neck_position.x(), -110.0) << support_x;
  }
}

// Plateau: four half planes along one line are a saddle however well they
// rest; popped, they are none.
TEST(FilmStability, FourFilmsAlongALine) {
  films::FilmComplex cross = test_films::fins_start({0, 60, 180, 240}, 4);
  films::FilmComplex settled = cross;
  const settle::FilmState state =
      settle::find_equilibrium(settled, {.refinements = 2});
  ASSERT_TRUE(state.failure);
  EXPECT_EQ(state.failure->kind, FailureKind::FilmUnstable);
  EXPECT_NE(state.report.verdict.find("three films"), std::string::npos)
      << state.report.verdict;
  EXPECT_LE(state.report.residual, state.report.residual_bound);
  EXPECT_GT(groom::pop_edges(cross).popped, 0);
  const settle::FilmState popped =
      settle::find_equilibrium(cross, {.refinements = 2});
  EXPECT_EQ(popped.report.verdict, "stable");
  EXPECT_LT(popped.report.energy, 0.99 * state.report.energy);
}

}  // namespace
}  // namespace meniscus::film_stability_test
