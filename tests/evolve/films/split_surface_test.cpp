#include "evolve/films/split_surface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/energy/energy.h"
#include "evolve/energy/fields.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/film_shapes.h"

namespace meniscus::split_surface_test {
namespace {

films::FilmComplex plain_tube() {
  return shapes::tube(1.0, 1.0, 24, 8, [](double) { return 1.0; });
}

// A solid belt leaves two catenoids, each from a ring to the belt: the film
// moves, the belt does not, and refinement keeps it.
TEST(SplitSurface, SolidRegionStaysAndHoldsTheFilm) {
  films::FilmComplex complex = plain_tube();
  const int belt = films::split_surface(
      complex, "tube", energy::place_expression("0.13 - abs(z)"),
      {"belt", false});
  EXPECT_EQ(belt, 1);
  EXPECT_EQ(complex.edges.size(), 48U);
  settle::FindOptions options;
  options.refinements = 2;
  const settle::FilmState state = settle::find_equilibrium(complex, options);
  EXPECT_FALSE(state.failure) << state.report.verdict;
  double waist = 1.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    for (const int v : complex.mesh.facets[f]) {
      const Vec3& p = complex.mesh.points[v];
      if (complex.mesh.facet_label[f] == belt) {
        // Still the prism of 24 sides that was cut out.
        EXPECT_LT(std::abs(p.z()), 0.125 + 1e-12);
        EXPECT_GE(p.head<2>().norm(), std::cos(std::numbers::pi / 24) - 1e-12);
      }
      waist = std::min(waist, p.head<2>().norm());
    }
  }
  EXPECT_LT(waist, 0.99);  // the films between, of height 0.375: 0.982
  EXPECT_GT(waist, 0.96);
}

TEST(SplitSurface, RegionsOfOneTensionAreTheOldFilm) {
  films::FilmComplex complex = plain_tube();
  const settle::FilmState whole = [&] {
    films::FilmComplex copy = complex;
    return settle::find_equilibrium(copy, {});
  }();
  films::split_surface(complex, "tube", energy::place_expression("z"),
                       {"upper", true, 1.0});
  const settle::FilmState parts = settle::find_equilibrium(complex, {});
  EXPECT_FALSE(parts.failure) << parts.report.verdict;
  EXPECT_NEAR(parts.report.energy, whole.report.energy, 1e-12);
}

TEST(SplitSurface, TensionOfARegionCounts) {
  films::FilmComplex complex = plain_tube();
  const double area = surface_area(complex.mesh);
  films::split_surface(complex, "tube", energy::place_expression("z"),
                       {"upper", true, 3.0});
  const energy::FilmEnergy energy(complex);
  EXPECT_NEAR(energy.value(complex.mesh.points, energy::targets_of(complex)),
              2.0 * area, 1e-12 * area);
}

TEST(SplitSurface, BodiesAndQuantitiesKeepTheRegion) {
  films::FilmComplex complex = shapes::drop(shapes::sphere(1.0, 2), 4.0);
  films::FilmQuantity area{"area", films::FilmQuantity::Role::Info,
                           films::FilmQuantity::Kind::Area};
  area.surfaces = {0};
  complex.quantities = {area};
  films::split_surface(complex, "film", energy::place_expression("x - 0.2"),
                       {"side", false});
  const energy::FilmEnergy energy(complex);
  EXPECT_NEAR(energy.volumes(complex.mesh.points)[0],
              enclosed_volume(complex.mesh), 1e-13);
  EXPECT_NEAR(energy.quantities(complex.mesh.points)[0],
              surface_area(complex.mesh), 1e-12);
}

TEST(SplitSurface, RefusesWhatMakesNoRegion) {
  films::FilmComplex complex = plain_tube();
  const Expression upper = energy::place_expression("z");
  const auto refused = [&](const std::string& surface, const Expression& where,
                           const films::Region& region) {
    EXPECT_THROW(films::split_surface(complex, surface, where, region),
                 InvalidInput);
  };
  refused("tub", upper, {"a", true, 1.0});
  refused("tube", upper, {"tube", true, 1.0});
  refused("tube", upper, {"a", true, 0.0});
  refused("tube", upper, {"a", true, std::nan("")});
  refused("tube", Expression(1.0), {"a", true, 1.0});
  refused("tube", Expression(-1.0), {"a", false});
  refused("tube", energy::place_expression("sqrt(z)"), {"a", false});
  EXPECT_EQ(complex.surfaces.size(), 1U);
  films::split_surface(complex, "tube", upper, {"a", false});
  refused("a", upper, {"b", false});
}

}  // namespace
}  // namespace meniscus::split_surface_test
