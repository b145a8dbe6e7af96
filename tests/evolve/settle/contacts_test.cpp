#include "evolve/settle/contacts.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_complexes.h"

namespace meniscus::contacts_test {
namespace {

/// A disk film across a ring of radius 1 at z = 0 under which a ball of radius
/// `ball` comes up to height `top`.
films::FilmComplex disk_over_ball(double ball, double top) {
  films::FilmComplex complex;
  complex.mesh.labels = {"film"};
  complex.surfaces = {{"film", true, 1.0}};
  complex.surfaces[0].constraints = 0;
  complex.curves = {{"ring", curves::Circle{}}};
  complex.level_sets = {
      {"ball",
       Expression::parse("sqrt(x^2 + y^2 + (z + " + std::to_string(ball - top) +
                             ")^2) - " + std::to_string(ball),
                         {"x", "y", "z"}),
       films::LevelSet::Side::AtLeast}};
  complex.constraint_sets = {{0}};
  constexpr int kAround = 12;
  complex.mesh.points.push_back(Vec3::Zero());
  complex.vertices.push_back({films::VertexKind::Free, -1, 0.0, 0, false});
  for (int i = 0; i < kAround; ++i) {
    const double t = static_cast<double>(i) / kAround;
    complex.mesh.points.push_back(curves::point_at(complex.curves[0].shape, t));
    complex.vertices.push_back({films::VertexKind::OnCurve, 0, t});
    complex.mesh.facets.push_back({0, 1 + i, 1 + (i + 1) % kAround});
    complex.mesh.facet_label.push_back(0);
  }
  return complex;
}

TEST(Contacts, AFilmFarFromItsWallDoesNotFeelIt) {
  films::FilmComplex complex = disk_over_ball(0.5, -0.1);
  const settle::FilmState state =
      settle::find_equilibrium(complex, {.refinements = 3});
  ASSERT_FALSE(state.failure) << state.report.verdict;
  for (const Vec3& p : state.points) {
    EXPECT_NEAR(p.z(), 0.0, 1e-12);
  }
}

// Over a ball the film is a catenoid from the ring to the circle where it
// leaves the ball tangentially, and lies on the ball inside. With rho, h the
// place of that circle: rho = c cosh(u), r sin(a) = rho, slope equal.
double height_of_leaving(double ball, double top) {
  // Catenoid r = c cosh((z - z0) / c) through (1, 0), tangent to the ball at
  // angle a from its top: rho = R sin a, z = top - R (1 - cos a), and the
  // film's meridian runs down the ball's tangent: dz/dr = -tan a, so
  // c = rho cos(angle of the meridian to the axis) = rho sin a.
  double low = 1e-6;
  double high = 1.5;
  const auto gap = [&](double a) {
    const double rho = ball * std::sin(a);
    const double z = top - ball * (1 - std::cos(a));
    const double c = rho * std::sin(a);
    return z - c * (std::acosh(1.0 / c) - std::acosh(rho / c));
  };
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (gap(middle) > 0.0 ? low : high) = middle;
  }
  const double a = 0.5 * (low + high);
  const double rho = ball * std::sin(a);
  const double c = rho * std::sin(a);
  const double z = top - ball * (1 - std::cos(a));
  const double u0 = std::acosh(1.0 / c);
  const double u1 = std::acosh(rho / c);
  const double catenoid =
      std::numbers::pi * c *
      (c * (u0 - u1) + c * (std::sinh(2 * u0) - std::sinh(2 * u1)) / 2.0);
  EXPECT_NEAR(z, c * (u0 - u1), 1e-9);
  return catenoid + 2 * std::numbers::pi * ball * ball * (1 - std::cos(a));
}

TEST(Contacts, AFilmOverABallLeavesItTangentially) {
  const double exact = height_of_leaving(0.5, 0.2);
  double error = 0.0;
  for (const int level : {3, 4, 5}) {
    films::FilmComplex complex = disk_over_ball(0.5, 0.2);
    const settle::FilmState state =
        settle::find_equilibrium(complex, {.refinements = level});
    ASSERT_FALSE(state.failure) << state.report.verdict;
    for (std::size_t v = 0; v < state.points.size(); ++v) {
      EXPECT_GT(jet_at(complex.level_sets[0].formula, state.points[v]).value,
                -1e-9);
    }
    const double next = std::abs(state.report.area - exact);
    if (level > 3) {
      EXPECT_GT(error / next, 2.5) << "level " << level;
    }
    error = next;
  }
  EXPECT_LT(error, 1e-3 * exact);
}

}  // namespace
}  // namespace meniscus::contacts_test
