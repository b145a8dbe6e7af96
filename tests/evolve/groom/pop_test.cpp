#include "evolve/groom/pop.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/films/body_sides.h"
#include "evolve/groom/refine.h"
#include "evolve/groom/remesh.h"
#include "tests/support/check_complex.h"
#include "tests/support/complex_builder.h"
#include "tests/support/film_complexes.h"
#include "tests/support/film_shapes.h"
#include "tests/support/nonmanifold_shapes.h"
#include "tests/support/systems.h"

namespace meniscus::pop_test {
namespace {

using nonmanifold::count_edges;
using nonmanifold::triple_lines;
using std::numbers::pi;
using test_films::fins_start;

constexpr double kRounding = 1e-12;

int most_films(const SurfaceMesh& mesh) {
  std::size_t most = 0;
  for (const auto& [edge, facets] : nonmanifold::edge_facets(mesh)) {
    most = std::max(most, facets.size());
  }
  return static_cast<int>(most);
}

TEST(PopEdges, MakesTwoTripleLinesOfFourFilms) {
  for (const int along : {1, 2, 7}) {
    SCOPED_TRACE(along);
    films::FilmComplex complex = fins_start({0, 60, 180, 240}, along);
    ASSERT_EQ(most_films(complex.mesh), 4);
    const groom::PopReport report = groom::pop_edges(complex);
    EXPECT_EQ(report.popped, 1);
    EXPECT_EQ(report.refused, 0);
    EXPECT_EQ(most_films(complex.mesh), 3);
    test_films::check_complex(complex);
    ASSERT_EQ(complex.surfaces.size(), 5U);
    EXPECT_EQ(complex.surfaces[4].name, "popped1");
    // Those at 60 degrees went together, whichever of the two pairs.
    const auto lines = triple_lines(complex.mesh).of_films;
    EXPECT_EQ(lines, (std::map<std::vector<int>, int>{{{0, 1, 4}, 1},
                                                      {{2, 3, 4}, 1}}));
    // The new film lies along their bisector.
    for (const Vec3& p : complex.mesh.points) {
      if (p.head<2>().norm() < 1.0) {
        EXPECT_NEAR(p.head<2>().dot(
                        Eigen::Vector2d(-std::sin(pi / 6), std::cos(pi / 6))),
                    0.0, kRounding);
      }
    }
  }
}

TEST(PopEdges, TakesFilmsOffUntilThreeAreLeft) {
  films::FilmComplex complex = fins_start({0, 50, 115, 180, 240, 300}, 4);
  const groom::PopReport report = groom::pop_edges(complex);
  EXPECT_EQ(report.popped, 3);
  EXPECT_EQ(most_films(complex.mesh), 3);
  test_films::check_complex(complex);
  EXPECT_EQ(triple_lines(complex.mesh).of_films.size(), 4U);
  EXPECT_EQ(groom::pop_edges(complex).popped, 0);
}

TEST(PopEdges, PopsAClosedLine) {
  // Four bands along the unit circle: inwards, up, outwards, down.
  constexpr int kAround = 12;
  test_films::ComplexBuilder builder;
  const auto ring = [&](double radius, double z, films::VertexKind kind) {
    std::vector<int> points;
    for (int i = 0; i < kAround; ++i) {
      const double a = 2.0 * pi * i / kAround;
      points.push_back(builder.vertex(
          Vec3(radius * std::cos(a), radius * std::sin(a), z), kind));
    }
    return points;
  };
  const std::vector<int> line = ring(1.0, 0.0, films::VertexKind::Free);
  const std::array<std::array<double, 2>, 4> ends = {
      {{0.6, 0.1}, {0.7, 0.4}, {1.5, 0.0}, {1.0, -0.5}}};
  for (std::size_t band = 0; band < ends.size(); ++band) {
    const auto rim =
        ring(ends[band][0], ends[band][1], films::VertexKind::Fixed);
    builder.band(builder.liquid("band" + std::to_string(band)), line, rim);
    for (int i = 0; i < kAround; ++i) {
      builder.fixed_edge(rim[i], rim[(i + 1) % kAround]);
    }
  }
  films::FilmComplex complex = builder.complex();
  EXPECT_EQ(count_edges(complex.mesh, 4), kAround);
  EXPECT_EQ(groom::pop_edges(complex).popped, 1);
  test_films::check_complex(complex);
  EXPECT_EQ(count_edges(complex.mesh, 4), 0);
  EXPECT_EQ(count_edges(complex.mesh, 3), 2 * kAround);
  // The first two bands make the smallest angle.
  EXPECT_EQ(triple_lines(complex.mesh).of_films,
            (std::map<std::vector<int>, int>{{{0, 1, 4}, 1}, {{2, 3, 4}, 1}}));
  EXPECT_EQ(triple_lines(complex.mesh).junctions, 0);
}

TEST(PopEdges, LeavesMarkedLinesAlone) {
  films::FilmComplex complex = fins_start({0, 90, 180, 270}, 3);
  complex.edges.push_back({.a = 1, .b = 2});
  const groom::PopReport report = groom::pop_edges(complex);
  EXPECT_EQ(report.popped, 2);  // above and below it
  EXPECT_EQ(report.refused, 1);
  EXPECT_EQ(count_edges(complex.mesh, 4), 1);
  EXPECT_EQ(nonmanifold::edge_facets(complex.mesh).at({1, 2}).size(), 4U);
  test_films::check_complex(complex);
}

// Four unit cubes about the z axis; their common edge has four films.
films::FilmComplex four_cubes() {
  test_films::ComplexBuilder builder;
  constexpr int kPieces = 2;
  const std::array<Vec3, 4> corner = {Vec3(0, 0, 0), Vec3(-1, 0, 0),
                                      Vec3(-1, -1, 0), Vec3(0, -1, 0)};
  const Vec3 x = Vec3::UnitX();
  const Vec3 y = Vec3::UnitY();
  const Vec3 z = Vec3::UnitZ();
  std::array<std::vector<films::BodySide>, 4> sides;
  for (int i = 0; i < 4; ++i) {
    const int skin = builder.liquid("skin" + std::to_string(i));
    const Vec3& o = corner[i];
    builder.plate(skin, o, y, x, kPieces);
    builder.plate(skin, o + z, x, y, kPieces);
    if (i == 0 || i == 3) {
      builder.plate(skin, o + x, y, z, kPieces);
    } else {
      builder.plate(skin, o, z, y, kPieces);
    }
    if (i < 2) {
      builder.plate(skin, o + y, z, x, kPieces);
    } else {
      builder.plate(skin, o, x, z, kPieces);
    }
    sides[i].push_back({skin, 1});
  }
  const auto wall = [&](int behind, int ahead, const Vec3& o, const Vec3& u,
                        const Vec3& v) {
    const int film = builder.liquid("wall" + std::to_string(behind));
    builder.plate(film, o, u, v, kPieces);
    sides[behind].push_back({film, 1});
    sides[ahead].push_back({film, -1});
  };
  wall(0, 1, Vec3::Zero(), z, y);  // normal -x
  wall(1, 2, -x, x, z);            // normal -y
  wall(2, 3, -y, y, z);            // normal +x
  wall(3, 0, Vec3::Zero(), z, x);  // normal +y
  for (int i = 0; i < 4; ++i) {
    films::ComplexBody body;
    body.name = "cube" + std::to_string(i);
    body.sides = sides[i];
    body.volume = 1.0;
    builder.complex().bodies.push_back(body);
  }
  return builder.complex();
}

double volume_of(const films::FilmComplex& complex, int body) {
  return enclosed_volume(films::body_surface(complex, complex.bodies[body]));
}

TEST(PopEdges, GivesTheNewFilmTheBodiesThatItParts) {
  films::FilmComplex complex = four_cubes();
  test_films::check_complex(complex);
  EXPECT_EQ(most_films(complex.mesh), 4);
  EXPECT_EQ(groom::pop_edges(complex).popped, 1);
  EXPECT_EQ(most_films(complex.mesh), 3);
  test_films::check_complex(complex);
  double sum = 0.0;
  for (int b = 0; b < 4; ++b) {
    EXPECT_NEAR(volume_of(complex, b), 1.0, 0.1);
    sum += volume_of(complex, b);
  }
  EXPECT_NEAR(sum, 4.0, kRounding);
  int parts = 0;
  for (const films::ComplexBody& body : complex.bodies) {
    for (const films::BodySide& side : body.sides) {
      parts += side.surface == 8 ? 1 : 0;
    }
  }
  EXPECT_EQ(parts, 2);
}

TEST(PopVertices, SeparatesAPinchedNeck) {
  const auto profile = [](double z) { return 0.005 + z * z; };
  for (const int around : {3, 4, 8}) {
    SCOPED_TRACE(around);
    films::FilmComplex complex = shapes::tube(1.0, 2.0, around, 6, profile);
    EXPECT_EQ(nonmanifold::components(complex.mesh), 1);
    EXPECT_GT(groom::collapse_tiny_edges(complex, 0.05), 0);
    test_films::check_complex(complex);
    EXPECT_EQ(nonmanifold::components(complex.mesh), 1);
    const groom::PopReport report = groom::pop_vertices(complex);
    EXPECT_EQ(report.popped, 1);
    ASSERT_EQ(report.places.size(), 1U);
    EXPECT_LT(report.places[0].norm(), 0.05);
    test_films::check_complex(complex);
    EXPECT_EQ(nonmanifold::components(complex.mesh), 2);
    EXPECT_EQ(systems::euler_characteristic(complex.mesh), 2);  // two disks
    EXPECT_EQ(groom::pop_vertices(complex).popped, 0);
  }
}

// Films from every edge of the cube to its centre.
films::FilmComplex cube_cone() {
  test_films::ComplexBuilder builder;
  std::array<int, 8> corner{};
  for (int i = 0; i < 8; ++i) {
    corner[i] = builder.vertex(Vec3(i & 1, i >> 1 & 1, i >> 2),
                               films::VertexKind::Fixed);
  }
  const int centre = builder.vertex(Vec3(0.5, 0.5, 0.5));
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) == 0) {
        const int film =
            builder.liquid("film" + std::to_string(i) + std::to_string(bit));
        builder.facet(film, corner[i], corner[i | bit], centre);
        builder.fixed_edge(corner[i], corner[i | bit]);
      }
    }
  }
  return builder.complex();
}

TEST(PopVertices, PopsTheConeOverACubeToASquareFilm) {
  for (int level = 0; level < 3; ++level) {
    SCOPED_TRACE(level);
    films::FilmComplex complex = cube_cone();
    for (int i = 0; i < level; ++i) {
      complex = groom::refine(complex).complex;
    }
    const auto before = triple_lines(complex.mesh);
    EXPECT_EQ(before.junctions, 1);
    EXPECT_EQ(groom::pop_edges(complex).popped, 0);
    const groom::PopReport report = groom::pop_vertices(complex);
    EXPECT_EQ(report.popped, 1);
    test_films::check_complex(complex);
    const auto after = triple_lines(complex.mesh);
    // Eight lines to the corners and the square's four sides.
    EXPECT_EQ(after.junctions, 4);
    EXPECT_EQ(after.of_films.size(), 12U);
    EXPECT_EQ(complex.surfaces.size(), 13U);
    EXPECT_EQ(groom::pop_vertices(complex).popped, 0);
    // The lines are still there when the films are remeshed.
    groom::remesh_films(complex, {.edge = 0.1});
    EXPECT_EQ(triple_lines(complex.mesh).of_films, after.of_films);
  }
}

TEST(PopVertices, KeepsMinimalCones) {
  for (const films::FilmComplex& start :
       {test_films::tetrahedral_frame_start(), test_films::cube_frame_start(),
        test_films::double_bubble_start(), test_films::triple_disk_start()}) {
    films::FilmComplex complex = start;
    EXPECT_EQ(groom::pop_edges(complex).popped, 0);
    EXPECT_EQ(groom::pop_vertices(complex).popped, 0);
    EXPECT_TRUE(systems::identical(complex, start));
  }
}

TEST(PopVertices, PopsAConeOverAnOctahedronAfterItsEdges) {
  // Lines of four films meet at the centre.
  test_films::ComplexBuilder builder;
  std::vector<int> tip;
  for (int k = 0; k < 3; ++k) {
    tip.push_back(builder.vertex(Vec3::Unit(k), films::VertexKind::Fixed));
    tip.push_back(builder.vertex(-Vec3::Unit(k), films::VertexKind::Fixed));
  }
  const int centre = builder.vertex(Vec3::Zero());
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j) {
      if (i / 2 != j / 2) {
        builder.facet(builder.liquid("film" + std::to_string(10 * i + j)),
                      tip[i], tip[j], centre);
        builder.fixed_edge(tip[i], tip[j]);
      }
    }
  }
  films::FilmComplex complex = groom::refine(builder.complex()).complex;
  EXPECT_EQ(most_films(complex.mesh), 4);
  EXPECT_EQ(groom::pop_edges(complex).popped, 6);
  EXPECT_EQ(most_films(complex.mesh), 3);
  EXPECT_EQ(groom::pop_vertices(complex).popped, 1);
  test_films::check_complex(complex);
  EXPECT_EQ(most_films(complex.mesh), 3);
  EXPECT_EQ(groom::pop_vertices(complex).popped, 0);
}

TEST(CollapseTiny, TakesShortEdgesOnly) {
  films::FilmComplex complex = test_films::cube_start(3);
  EXPECT_EQ(groom::collapse_tiny_edges(complex, 0.1), 0);
  complex.mesh.points.back() +=
      0.99 * (complex.mesh.points[complex.mesh.facets.back()[0]] -
              complex.mesh.points.back());
  EXPECT_EQ(groom::collapse_tiny_edges(complex, 0.1), 1);
  test_films::check_complex(complex);
  EXPECT_EQ(systems::euler_characteristic(complex.mesh), 2);
  EXPECT_THROW(groom::collapse_tiny_edges(complex, std::nan("")), InvalidInput);
  films::FilmComplex frame = test_films::cube_frame_start();
  groom::collapse_tiny_edges(frame, 100.0);
  test_films::check_complex(frame);
  EXPECT_EQ(frame.edges.size(), 12U);
}

}  // namespace
}  // namespace meniscus::pop_test
