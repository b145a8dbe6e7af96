// The verdict on films of known index: stable ones on one side of a limit,
// saddles on the other, pinching where no film is left.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/delaunay_curves.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_race.h"

namespace meniscus {
namespace {

FilmReport report_of(const FilmComplex& start) {
  FilmComplex complex = start;
  return find_refined(complex, 0).report;
}

films::TubeSpec tube(double length) {
  return {.length = length,
          .around = 24,
          .rows = static_cast<int>(std::lround(4.0 * length))};
}

FilmReport at_pressure(double length) {
  films::TubeSpec spec = tube(length);
  spec.pressure = films::prism_pressure(spec);
  return report_of(films::tube_start(spec));
}

FilmReport at_volume(double length) {
  films::TubeSpec spec = tube(length);
  spec.volume = films::prism_volume(spec);
  return report_of(films::tube_start(spec));
}

FilmReport catenoid_between(double spacing) {
  FilmComplex start = films::catenoid_start(24, 8);
  for (Curve& curve : start.curves) {
    std::get<Circle>(curve.shape).center.z() *= spacing;
  }
  for (Vec3& p : start.mesh.points) {
    p.z() *= spacing;
  }
  return report_of(start);
}

// Limit pi at fixed pressure. Beyond it the prism rests as a saddle.
TEST(FilmStability, CylinderAtFixedPressure) {
  for (const double length : {2.0, 3.0}) {
    const FilmReport report = at_pressure(length);
    EXPECT_EQ(report.index, 0) << length;
    EXPECT_GT(report.min_eigenvalue, 0.0) << length;
    EXPECT_EQ(report.verdict, "stable") << length;
  }
  const FilmReport beyond = at_pressure(3.3);
  EXPECT_EQ(beyond.index, 1) << beyond.verdict;
  EXPECT_LT(beyond.min_eigenvalue, 0.0);
}

// Limit 2 pi at fixed volume (Plateau, Rayleigh).
TEST(FilmStability, CylinderAtFixedVolume) {
  for (const double length : {4.0, 6.1}) {
    const FilmReport report = at_volume(length);
    EXPECT_EQ(report.index, 0) << length;
    EXPECT_EQ(report.verdict, "stable") << length;
  }
  const FilmReport beyond = at_volume(6.5);
  EXPECT_EQ(beyond.index, 1) << beyond.verdict;
  EXPECT_LE(beyond.residual, beyond.residual_bound) << "a settled saddle";
  EXPECT_NE(beyond.verdict.find("unstable"), std::string::npos);
}

TEST(FilmStability, SymmetricSaddles) {
  const FilmReport tube = report_of(films::long_tube_saddle());
  EXPECT_EQ(tube.index, 1) << tube.verdict;
  const FilmReport catenoid = report_of(films::thin_catenoid_saddle());
  EXPECT_EQ(catenoid.index, 1) << catenoid.verdict;
  EXPECT_NEAR(0.5 * catenoid.smallest_neck,
              films::thin_catenoid(1.0, 1.0).waist, 0.01);
}

// Found at 1.31, none at 1.34 (limit 1.32548).
TEST(FilmStability, CatenoidNearItsLimit) {
  EXPECT_EQ(catenoid_between(1.31).verdict, "stable");
  const FilmReport beyond = catenoid_between(1.34);
  EXPECT_NE(beyond.verdict.find("pinching"), std::string::npos)
      << beyond.verdict;
  // Both rings at +-0.67: the neck is at the middle, within 5 % of 1.34.
  EXPECT_NEAR(beyond.neck_position.z(), 0.0, 0.05 * 1.34);
}

// From V = 13 stable, at 12.5 a neck pinches near the small ring.
TEST(FilmStability, StrutNearItsLimit) {
  FilmComplex strut = films::strut_start();
  strut.bodies[0].volume = 13.0;
  FilmComplex stable = strut;
  const FilmState film = find_refined(stable, 2);
  EXPECT_EQ(film.report.verdict, "stable");
  strut.bodies[0].volume = 12.5;
  const FilmState beyond = find_refined(strut, 2);
  EXPECT_NE(beyond.report.verdict, "stable");
  // The small ring is at z = 4.
  EXPECT_GT(beyond.report.neck_position.z(), 3.0) << beyond.report.verdict;
  EXPECT_LT(beyond.report.neck_position.z(), 4.0);
}

}  // namespace
}  // namespace meniscus
