#include "evolve/frozen/resolutions.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/groom/check_complex.h"
#include "evolve/settle/find_equilibrium.h"
#include "tests/support/delaunay_curves.h"
#include "tests/support/film_complexes.h"
#include "tests/support/nonmanifold_shapes.h"

namespace meniscus::resolutions_test {
namespace {

using nonmanifold::triple_lines;

// Each film is meshed anew: its error's constant varies a little with that.
constexpr double kSecondOrder = 1.7;

films::FilmComplex settled(films::FilmComplex complex, int refinements) {
  const settle::FilmState state =
      settle::find_equilibrium(complex, {.refinements = refinements});
  EXPECT_FALSE(state.failure) << state.report.verdict;
  return complex;
}

void expect_on_curves(const films::FilmComplex& complex) {
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = complex.vertices[v];
    if (vertex.kind == films::VertexKind::OnCurve) {
      const Vec3 place =
          curves::point_at(complex.curves[vertex.curve].shape, vertex.t);
      EXPECT_LT((complex.mesh.points[v] - place).norm(), 1e-12);
    }
  }
}

/// Films at edge lengths each half of the one before; returns the finest.
frozen::FilmResolution expect_second_order(const films::FilmComplex& film,
                                           const std::vector<double>& edges,
                                           double exact) {
  std::vector<frozen::FilmResolution> films = frozen::at_edges(film, edges);
  double before = 0.0;
  for (std::size_t k = 0; k < films.size(); ++k) {
    const settle::FilmReport& report = films[k].state.report;
    SCOPED_TRACE(edges[k]);
    EXPECT_EQ(films[k].edge, edges[k]);
    EXPECT_EQ(report.verdict, "stable");
    EXPECT_LE(report.residual, report.residual_bound);
    EXPECT_NO_THROW(groom::check_complex(films[k].complex));
    EXPECT_NEAR(mean_edge_length(films[k].complex.mesh), edges[k],
                0.15 * edges[k]);
    EXPECT_EQ(films[k].complex.mesh.labels, film.mesh.labels);
    expect_on_curves(films[k].complex);
    for (const settle::BodyState& body : report.bodies) {
      EXPECT_NEAR(body.volume, body.target_volume, 1e-9 * body.target_volume);
    }
    const double error = std::abs(report.energy - exact);
    if (k > 0) {
      EXPECT_GT(std::log2(before / error), kSecondOrder)
          << before << ", " << error;
    }
    before = error;
  }
  return std::move(films.back());
}

TEST(Resolutions, CatenoidAtThreeEdges) {
  expect_second_order(settled(test_films::catenoid_start(), 1),
                      {0.12, 0.06, 0.03}, test_films::catenoid(1.0, 1.0).area);
}

TEST(Resolutions, BodyKeepsItsVolume) {
  const films::FilmComplex film = settled(test_films::cube_start(), 1);
  expect_second_order(film, {0.16, 0.08, 0.04},
                      test_films::sphere_of_volume(1.0).area);
}

TEST(Resolutions, TripleLineStays) {
  const films::FilmComplex film = settled(test_films::triple_disk_start(), 2);
  const frozen::FilmResolution finest = expect_second_order(
      film, {0.12, 0.06, 0.03}, test_films::triple_disk().area);
  EXPECT_EQ(triple_lines(finest.complex.mesh).of_films,
            triple_lines(film.mesh).of_films);
}

// Rims keep their edges, so the film may be coarser between them only.
TEST(Resolutions, CoarserThanTheFilm) {
  const films::FilmComplex film = settled(test_films::catenoid_start(), 3);
  const frozen::FilmResolution coarse = frozen::at_edge(film, 0.12);
  EXPECT_EQ(coarse.state.report.verdict, "stable");
  EXPECT_LT(coarse.complex.mesh.facets.size(), film.mesh.facets.size());
  EXPECT_NEAR(coarse.state.report.energy, test_films::catenoid(1.0, 1.0).area,
              0.02);
  expect_on_curves(coarse.complex);
}

// One edge's film does not depend on the others.
TEST(Resolutions, AreIndependent) {
  const films::FilmComplex film = settled(test_films::catenoid_start(), 1);
  const Points among = frozen::at_edges(film, {0.2, 0.1})[1].state.points;
  EXPECT_EQ(among, frozen::at_edge(film, 0.1).state.points);
}

TEST(Resolutions, RefuseWhatIsNoLength) {
  const films::FilmComplex film = test_films::catenoid_start();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double edge : {0.0, -1.0, kNan, 1e-9}) {
    EXPECT_THROW(frozen::at_edge(film, edge), InvalidInput) << edge;
  }
}

}  // namespace
}  // namespace meniscus::resolutions_test
