#include "tests/support/film_complexes.h"

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/geometry/edge_key.h"

namespace meniscus::film_complexes_test {
namespace {

using std::numbers::pi;

constexpr double kRounding = 1e-12;  // sums of a few hundred terms of size 1

struct EdgeUse {
  int facets = 0;
  int balance = 0;  // facets one way less facets the other way
  std::set<int> labels;
};

std::map<Edge, EdgeUse> edge_uses(const SurfaceMesh& mesh) {
  std::map<Edge, EdgeUse> uses;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.facets[f][k];
      const int b = mesh.facets[f][(k + 1) % 3];
      EdgeUse& use = uses[edge_key(a, b)];
      ++use.facets;
      use.balance += a < b ? 1 : -1;
      use.labels.insert(mesh.facet_label[f]);
    }
  }
  return uses;
}

double body_volume(const films::FilmComplex& complex,
                   const films::ComplexBody& body) {
  double sum = 0.0;
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    for (const films::BodySide& side : body.sides) {
      if (side.surface == complex.mesh.facet_label[f]) {
        const Triangle& t = complex.mesh.facets[f];
        const Points& p = complex.mesh.points;
        sum += side.sign * p[t[0]].dot(p[t[1]].cross(p[t[2]])) / 6.0;
      }
    }
  }
  return sum;
}

int liquid_facets(const films::FilmComplex& complex) {
  int count = 0;
  for (const int label : complex.mesh.facet_label) {
    count += complex.surfaces[label].liquid ? 1 : 0;
  }
  return count;
}

// Conforming, one way round within a surface, open only along marked edges,
// every marked edge an edge, bodies closed, rims on their curves.
void expect_sound(const films::FilmComplex& complex, int triple_edges) {
  ASSERT_EQ(complex.vertices.size(), complex.mesh.points.size());
  ASSERT_EQ(complex.surfaces.size(), complex.mesh.labels.size());
  std::set<Edge> marked;
  const std::map<Edge, EdgeUse> uses = edge_uses(complex.mesh);
  for (const films::ComplexEdge& edge : complex.edges) {
    const Edge key = edge_key(edge.a, edge.b);
    EXPECT_TRUE(marked.insert(key).second) << "marked twice";
    EXPECT_TRUE(uses.contains(key)) << edge.a << "-" << edge.b;
  }
  int triple = 0;
  for (const auto& [edge, use] : uses) {
    if (use.facets == 1) {
      EXPECT_TRUE(marked.contains(edge)) << edge[0] << "-" << edge[1];
    } else if (use.facets == 2 && use.labels.size() == 1) {
      EXPECT_EQ(use.balance, 0) << edge[0] << "-" << edge[1];
    }
    triple += use.facets == 3 ? 1 : 0;
    EXPECT_LE(use.facets, 3);
  }
  EXPECT_EQ(triple, triple_edges);
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    const films::ComplexVertex& vertex = complex.vertices[v];
    if (vertex.kind == films::VertexKind::OnCurve) {
      EXPECT_EQ(curves::point_at(complex.curves[vertex.curve].shape, vertex.t),
                complex.mesh.points[v]);
    }
  }
}

TEST(FilmComplexes, Catenoid) {
  const films::FilmComplex complex = test_films::catenoid_start();
  expect_sound(complex, 0);
  EXPECT_EQ(complex.mesh.facets.size(), 60U);
  EXPECT_NEAR(surface_area(complex.mesh), 30.0 * std::sin(pi / 15.0),
              kRounding);
}

TEST(FilmComplexes, Cube) {
  const films::FilmComplex complex = test_films::cube_start();
  expect_sound(complex, 0);
  EXPECT_EQ(complex.mesh.facets.size(), 216U);
  EXPECT_NEAR(surface_area(complex.mesh), 6.0, kRounding);
  EXPECT_NEAR(body_volume(complex, complex.bodies[0]), 1.0, kRounding);
}

TEST(FilmComplexes, Strut) {
  const films::FilmComplex complex = test_films::strut_start();
  expect_sound(complex, 0);
  EXPECT_EQ(liquid_facets(complex), 240);
  EXPECT_NEAR(surface_area(complex.mesh, complex.mesh.label_of("foot")), 4.0,
              kRounding);
  EXPECT_NEAR(surface_area(complex.mesh, complex.mesh.label_of("head")),
              10.0 * 0.36 * std::sin(pi / 10.0), kRounding);
  // Between the two prisms of its ends.
  const double volume = body_volume(complex, complex.bodies[0]);
  EXPECT_GT(volume, 4.0 * 10.0 * 0.36 * std::sin(pi / 10.0));
  EXPECT_LT(volume, 16.0);
}

TEST(FilmComplexes, TripleDisk) {
  const films::FilmComplex complex = test_films::triple_disk_start();
  expect_sound(complex, 12);
  EXPECT_EQ(complex.mesh.facets.size(), 60U);
  EXPECT_NEAR(surface_area(complex.mesh, complex.mesh.label_of("disk")),
              6.0 * 0.64 * std::sin(pi / 6.0), kRounding);
}

TEST(FilmComplexes, CubeFrame) {
  const films::FilmComplex complex = test_films::cube_frame_start();
  expect_sound(complex, 12);
  EXPECT_EQ(complex.mesh.facets.size(), 40U);
  EXPECT_EQ(complex.edges.size(), 12U);
  // Trapezia of sides 1 and 0.2; triangles on edges of length 1.
  const double trapezium = 0.6 * std::hypot(0.5, 0.4);
  const double side = 0.5 * 0.4 * std::sqrt(2.0);
  EXPECT_NEAR(surface_area(complex.mesh), 8 * trapezium + 4 * side + 0.04,
              kRounding);
}

TEST(FilmComplexes, TetrahedralFrame) {
  const films::FilmComplex complex = test_films::tetrahedral_frame_start();
  expect_sound(complex, 8);
  EXPECT_EQ(complex.mesh.facets.size(), 24U);
  EXPECT_EQ(complex.edges.size(), 12U);
  EXPECT_GT(surface_area(complex.mesh), 6.0 * std::sqrt(2.0));
}

TEST(FilmComplexes, DoubleBubble) {
  const films::FilmComplex complex = test_films::double_bubble_start(2);
  expect_sound(complex, 8);
  EXPECT_EQ(complex.mesh.facets.size(), 11U * 4 * 4);
  EXPECT_NEAR(surface_area(complex.mesh), 11.0, kRounding);
  for (const films::ComplexBody& body : complex.bodies) {
    EXPECT_NEAR(body_volume(complex, body), 1.0, kRounding);
  }
}

TEST(FilmComplexes, SessileCap) {
  const double angle = pi / 3.0;
  const films::FilmComplex complex = test_films::sessile_cap_start(angle, 2);
  expect_sound(complex, 0);
  EXPECT_EQ(complex.mesh.facets.size(), 5U * 4 * 4);
  EXPECT_EQ(complex.edges.size(), 8U);
  EXPECT_NEAR(body_volume(complex, complex.bodies[0]), 1.0, kRounding);
  // The rim's integral is linear along each edge: its middle gives it exactly.
  double wall = 0.0;
  for (const films::ComplexEdge& edge : complex.edges) {
    const Vec3& a = complex.mesh.points[edge.a];
    const Vec3& b = complex.mesh.points[edge.b];
    const Vec3 middle = 0.5 * (a + b);
    const std::array<double, 3> at = {middle.x(), middle.y(), middle.z()};
    for (int k = 0; k < 3; ++k) {
      const Expression& field = complex.integrals[0].field[k];
      wall += field.evaluate(std::span<const double>(at)) * (b - a)[k];
    }
  }
  EXPECT_NEAR(wall, -std::cos(angle), kRounding);
}

TEST(FilmComplexes, Tube) {
  const test_films::TubeSpec spec{.radius = 0.5, .length = 3.0, .volume = 2.0};
  const films::FilmComplex complex = test_films::tube_start(spec);
  expect_sound(complex, 0);
  EXPECT_EQ(liquid_facets(complex), 2 * spec.around * spec.rows);
  EXPECT_NEAR(body_volume(complex, complex.bodies[0]),
              test_films::prism_volume(spec), kRounding);
  EXPECT_EQ(complex.bodies[0].volume, 2.0);
}

TEST(FilmComplexes, Saddles) {
  const films::FilmComplex tube = test_films::long_tube_saddle();
  expect_sound(tube, 0);
  EXPECT_NEAR(*tube.bodies[0].volume, body_volume(tube, tube.bodies[0]),
              kRounding);
  const films::FilmComplex catenoid = test_films::thin_catenoid_saddle(48, 24);
  expect_sound(catenoid, 0);
  double waist = 1.0;
  for (const Vec3& p : catenoid.mesh.points) {
    waist = std::min(waist, p.head<2>().norm());
  }
  EXPECT_NEAR(waist, 0.2350, 1e-4);
  // pi (c h + c^2 sinh(h / c)) with h = 1, less the chords' share.
  const double exact = pi * (waist + waist * waist * std::sinh(1.0 / waist));
  EXPECT_NEAR(surface_area(catenoid.mesh), exact, 0.01 * exact);
}

}  // namespace
}  // namespace meniscus::film_complexes_test
