#include "evolve/settle/descent.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/groom/refine.h"
#include "evolve/settle/equilibrium.h"
#include "evolve/settle/slide_vertices.h"
#include "tests/support/film_complexes.h"

namespace meniscus::descent_test {
namespace {

// Where a parabola's minimum is lost in rounding of the energy sum, its
// residual is the root of that: 1e-8; the energy itself is good to 1e-12.
constexpr double kEnergy = 1e-10;
constexpr double kResidual = 1e-6;

/// About 800 facets, not far from rest.
films::FilmComplex near_sphere() {
  films::FilmComplex complex = groom::refine(test_films::cube_start(3)).complex;
  for (Vec3& p : complex.mesh.points) {
    const Vec3 out = p - Vec3::Constant(0.5);
    p = Vec3::Constant(0.5) +
        0.6 * out.normalized() * (1.0 + 0.1 * out.x() * out.y() / 0.25);
  }
  return complex;
}

films::FilmComplex near_catenoid() {
  return groom::refine(groom::refine(test_films::catenoid_start(15, 2)).complex)
      .complex;
}

class Descends : public testing::TestWithParam<settle::DescentMethod> {};

void ends_where_newton_ends(const films::FilmComplex& complex,
                            settle::DescentMethod method) {
  const energy::FilmEnergy energy(complex);
  const films::FilmTargets targets = energy::targets_of(complex);
  const Points directions = energy.space().directions(complex.mesh.points);
  Points points = complex.mesh.points;
  const settle::DescentReport report =
      settle::descend(energy, targets, directions, points,
                      {.method = method,
                       .max_steps = 5000,
                       .residual_bound = kResidual * energy.mean_edge(points)});
  for (std::size_t k = 1; k < report.energies.size(); ++k) {
    EXPECT_LT(report.energies[k], report.energies[k - 1]) << "step " << k;
  }
  const settle::FilmState newton = settle::settle_along(
      energy, complex, targets, complex.mesh.points, directions, {}, 0.0, {});
  ASSERT_FALSE(newton.failure) << newton.report.verdict;
  EXPECT_NEAR(report.energies.back(), newton.report.energy,
              kEnergy * newton.report.energy)
      << report.message << " after " << report.steps << ", residual "
      << report.residual;
}

TEST_P(Descends, ToNewtonsEnergyOnASphereOfGivenVolume) {
  ends_where_newton_ends(near_sphere(), GetParam());
}

TEST_P(Descends, ToNewtonsEnergyOnACatenoid) {
  ends_where_newton_ends(near_catenoid(), GetParam());
}

TEST_P(Descends, KeepsVolumeAtEveryStep) {
  const films::FilmComplex complex = near_sphere();
  const energy::FilmEnergy energy(complex);
  const films::FilmTargets targets = energy::targets_of(complex);
  Points points = complex.mesh.points;
  settle::descend(energy, targets, energy.space().directions(points), points,
                  {.method = GetParam(), .max_steps = 7});
  EXPECT_NEAR(energy.volumes(points)[0], 1.0, 1e-10);
}

// Facets inscribed in a waist miss area to either side: sliding them uses it.
TEST(SlideVertices, LowersTheEnergyOfASettledFilmAtItsVolume) {
  for (films::FilmComplex complex : {near_sphere(), near_catenoid()}) {
    energy::FilmEnergy energy(complex);
    const films::FilmTargets targets = energy::targets_of(complex);
    const settle::FilmState settled = settle::settle_in_normals(
        energy, complex, targets, complex.mesh.points, {});
    ASSERT_FALSE(settled.failure) << settled.report.verdict;
    complex.mesh.points = settled.points;
    const settle::FilmState slid =
        settle::slide_vertices(complex, {.steps = 50});
    ASSERT_FALSE(slid.failure) << slid.report.verdict;
    EXPECT_LT(slid.report.energy, (1.0 - 1e-6) * settled.report.energy);
    EXPECT_GT(slid.report.energy, (1.0 - 1e-2) * settled.report.energy);
    EXPECT_LE(slid.report.residual, slid.report.residual_bound);
    EXPECT_EQ(complex.mesh.points, slid.points);
    if (!complex.bodies.empty()) {
      EXPECT_NEAR(energy.volumes(slid.points)[0], 1.0, 1e-10);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    ByName, Descends,
    testing::Values(settle::DescentMethod::Gradient,
                    settle::DescentMethod::ConjugateGradients));

/// As a film that never comes to rest: it ends where the limit says, lower than
/// it began.
TEST(Descent, EndsWithItsEvaluations) {
  const films::FilmComplex complex = near_sphere();
  const energy::FilmEnergy energy(complex);
  Points points = complex.mesh.points;
  const settle::DescentReport report = settle::descend(
      energy, energy::targets_of(complex), energy.space().directions(points),
      points, {.max_steps = 1'000'000, .max_evaluations = 200});
  EXPECT_FALSE(report.converged);
  EXPECT_GE(report.evaluations, 200);
  EXPECT_LT(report.evaluations, 1000);
  EXPECT_EQ(report.message, "the evaluations allowed are used up");
  EXPECT_LT(report.energies.back(), report.energies.front());
}

/// The points are where it was when the stop came.
TEST(Descent, KeepsItsPlaceWhenStopped) {
  struct AfterSome : Monitor {
    bool stop_requested() const override { return ++asked > 20; }
    mutable int asked = 0;
  } monitor;
  const films::FilmComplex complex = near_sphere();
  const energy::FilmEnergy energy(complex);
  const films::FilmTargets targets = energy::targets_of(complex);
  Points points = complex.mesh.points;
  EXPECT_THROW(
      settle::descend(energy, targets, energy.space().directions(points),
                      points, {.max_steps = 1'000'000, .monitor = &monitor}),
      Interrupted);
  Points start = complex.mesh.points;  // at its volume
  settle::descend(energy, targets, energy.space().directions(start), start,
                  {.max_steps = 0});
  EXPECT_LT(energy.value(points, targets), energy.value(start, targets));
}

}  // namespace
}  // namespace meniscus::descent_test
