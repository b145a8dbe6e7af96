// Surface Evolver loads our starts with the same energies and volumes, and its
// films end at the closed forms: the two sides of the speed table do the same
// work.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/delaunay_curves.h"
#include "tests/support/evolver.h"
#include "tests/support/film_complexes.h"
#include "tests/support/not_here.h"

namespace meniscus::evolver_start_test {
namespace {

constexpr double kPrinted = 1e-12;  // relative: 15 digits, hundreds of terms
// Linear facets at about a thousand: area is off by half a per cent at most.
constexpr double kCoarse = 5e-3;

double film_area(const films::FilmComplex& complex) {
  double area = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.surfaces[complex.mesh.facet_label[f]].liquid) {
      area += 0.5 * area_vector2(complex.mesh, static_cast<int>(f)).norm();
    }
  }
  return area;
}

constexpr const char* kDescent = "g 20; u; V; g 10;";
// A drop that slides on its plane: Newton only from near rest.
constexpr const char* kLongDescent = "g 200; u; V; g 100;";

struct Expected {
  double start_energy;
  double energy;
  const char* descent = kDescent;
};

void expect_same_film(const films::FilmComplex& start,
                      const std::vector<double>& volumes,
                      const Expected& expected) {
  if (!have_evolver()) {
    MENISCUS_NOT_HERE("evolver (Debian package evolver) is not installed");
  }
  const EvolverRun run = run_evolver(start, {.refinements = 2,
                                             .script = EvolverScript::Typical,
                                             .descent = expected.descent,
                                             .last_hessians = 4});
  ASSERT_TRUE(run.ended) << run.output;
  EXPECT_NEAR(run.start_energy, expected.start_energy,
              kPrinted * expected.start_energy);
  ASSERT_EQ(run.start_volumes.size(), volumes.size());
  for (std::size_t b = 0; b < run.start_volumes.size(); ++b) {
    EXPECT_NEAR(run.start_volumes[b], volumes[b], 2 * kPrinted);
  }
  EXPECT_TRUE(run.converged) << run.output;
  EXPECT_NEAR(run.energy, expected.energy, kCoarse * expected.energy);
}

TEST(EvolverStart, Catenoid) {
  const films::FilmComplex start = test_films::catenoid_start();
  expect_same_film(start, {},
                   {film_area(start), test_films::catenoid(1.0, 1.0).area});
}

TEST(EvolverStart, Cube) {
  const films::FilmComplex start = test_films::cube_start();
  expect_same_film(start, {1.0}, {6.0, test_films::sphere_of_volume(1.0).area});
}

TEST(EvolverStart, Strut) {
  constexpr double kArea = 26.89002;  // at volume 14, extrapolated
  const films::FilmComplex start = test_films::strut_start();
  // All facets, caps included, as cones to the origin.
  double volume = 0.0;
  for (const Triangle& t : start.mesh.facets) {
    const Points& p = start.mesh.points;
    volume += p[t[0]].dot(p[t[1]].cross(p[t[2]])) / 6.0;
  }
  expect_same_film(start, {volume}, {film_area(start), kArea});
}

TEST(EvolverStart, TripleDisk) {
  const films::FilmComplex start = test_films::triple_disk_start();
  expect_same_film(start, {},
                   {film_area(start), test_films::triple_disk().area});
}

TEST(EvolverStart, Frames) {
  const films::FilmComplex cube = test_films::cube_frame_start();
  expect_same_film(cube, {}, {film_area(cube), test_films::kCubeFrameArea});
  const films::FilmComplex tetrahedron = test_films::tetrahedral_frame_start();
  expect_same_film(tetrahedron, {},
                   {film_area(tetrahedron), test_films::kTetrahedralFrameArea});
}

TEST(EvolverStart, DoubleBubble) {
  expect_same_film(test_films::double_bubble_start(), {1.0, 1.0},
                   {11.0, test_films::double_bubble(1.0).area});
}

TEST(EvolverStart, SessileCap) {
  const double angle = 75.0 * std::numbers::pi / 180.0;
  expect_same_film(test_films::sessile_cap_start(angle), {1.0},
                   {5.0 - std::cos(angle),
                    test_films::sessile_cap(1.0, angle).energy, kLongDescent});
}

}  // namespace
}  // namespace meniscus::evolver_start_test
