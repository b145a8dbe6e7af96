#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "evolve/groom/flip_average.h"
#include "evolve/groom/refine.h"
#include "evolve/groom/remesh.h"
#include "tests/support/check_complex.h"
#include "tests/support/film_complexes.h"
#include "tests/support/nonmanifold_shapes.h"
#include "tests/support/systems.h"

namespace meniscus::remesh_lines_test {
namespace {

using nonmanifold::triple_lines;
using systems::Part;

constexpr double kLeastAngle = 17.0;  // [deg] beside held rims and frames
constexpr double kAreaChange = 0.2;   // coarse edges cut a cube's corners off
constexpr double kLineRounding = 1e-12;

struct Case {
  const char* name;
  films::FilmComplex start;
  int levels;  // refined before
  double edge;
};

std::vector<Case> cases() {
  return {{"triple disk", test_films::triple_disk_start(), 2, 0.13},
          {"cube frame", test_films::cube_frame_start(), 3, 0.09},
          {"tetrahedral frame", test_films::tetrahedral_frame_start(), 3, 0.2},
          {"double bubble", test_films::double_bubble_start(), 2, 0.14},
          {"sessile", test_films::sessile_cap_start(1.0), 2, 0.12}};
}

films::FilmComplex refined(films::FilmComplex complex, int levels) {
  for (int i = 0; i < levels; ++i) {
    complex = groom::refine(complex).complex;
  }
  return complex;
}

// Places where lines meet, sorted.
std::vector<std::array<double, 3>> junctions(const SurfaceMesh& mesh) {
  std::map<int, int> valence;
  for (const auto& [edge, facets] : nonmanifold::edge_facets(mesh)) {
    if (facets.size() > 2) {
      ++valence[edge[0]];
      ++valence[edge[1]];
    }
  }
  std::vector<std::array<double, 3>> places;
  for (const auto& [v, count] : valence) {
    if (count > 2) {
      const Vec3& p = mesh.points[v];
      places.push_back({p.x(), p.y(), p.z()});
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

void expect_marks_on_edges(const films::FilmComplex& complex) {
  const auto uses = nonmanifold::edge_facets(complex.mesh);
  for (const films::ComplexEdge& mark : complex.edges) {
    EXPECT_EQ(uses.count(edge_key(mark.a, mark.b)), 1U);
  }
}

TEST(RemeshLines, KeepTheirFilmsAndJunctionsAtSeveralSizes) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    films::FilmComplex complex = refined(c.start, c.levels);
    nonmanifold::shake(complex, 0.15 * c.edge, 3);
    const auto lines = triple_lines(complex.mesh);
    const auto places = junctions(complex.mesh);
    const int euler = systems::euler_characteristic(complex.mesh);
    const double area = surface_area(complex.mesh);
    for (const double factor : {1.0, 0.6, 1.6}) {
      SCOPED_TRACE(factor);
      groom::remesh_films(complex, {.edge = factor * c.edge});
      const auto now = triple_lines(complex.mesh);
      EXPECT_EQ(now.of_films, lines.of_films);
      EXPECT_EQ(now.junctions, lines.junctions);
      EXPECT_EQ(junctions(complex.mesh), places);
      EXPECT_EQ(systems::euler_characteristic(complex.mesh), euler);
      EXPECT_NEAR(surface_area(complex.mesh) / area, 1.0, kAreaChange);
      test_films::check_complex(complex);
      expect_marks_on_edges(complex);
      const auto q = systems::quality(complex, Part::Films);
      EXPECT_GT(q.smallest_angle, kLeastAngle);
      EXPECT_NEAR(q.mean / (factor * c.edge), 1.0, 0.25);
    }
  }
}

TEST(RemeshLines, FollowTheTargetLength) {
  films::FilmComplex complex = refined(test_films::triple_disk_start(), 2);
  const int before = nonmanifold::count_edges(complex.mesh, 3);
  EXPECT_EQ(before, 48);
  groom::remesh_films(complex, {.edge = 0.06});
  // The circle of radius 0.8 in pieces of 0.06 .. 4/3 of it.
  EXPECT_GT(nonmanifold::count_edges(complex.mesh, 3), 60);
  groom::remesh_films(complex, {.edge = 0.3});
  EXPECT_LT(nonmanifold::count_edges(complex.mesh, 3), 26);
  EXPECT_GT(nonmanifold::count_edges(complex.mesh, 3), 12);
}

TEST(RemeshLines, StayOnTheirWallWithTheirIntegrals) {
  films::FilmComplex complex = refined(test_films::sessile_cap_start(1.0), 2);
  const auto wetted = [&] {
    double sum = 0.0;
    for (const films::ComplexEdge& e : complex.edges) {
      const Vec3& a = complex.mesh.points[e.a];
      const Vec3& b = complex.mesh.points[e.b];
      sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
      EXPECT_EQ(e.integrals, 0);
      EXPECT_EQ(e.constraints, 0);
    }
    return sum;
  };
  const double before = wetted();
  for (const double edge : {0.06, 0.2}) {
    groom::remesh_films(complex, {.edge = edge});
    EXPECT_EQ(complex.edges.size(),
              static_cast<std::size_t>(systems::open_edges(complex.mesh)));
    EXPECT_NEAR(wetted() / before, 1.0, 0.1);
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
      if (complex.vertices[v].constraints >= 0) {
        EXPECT_NEAR(complex.mesh.points[v].z(), 0.0, kLineRounding);
      }
    }
  }
}

TEST(CheckComplex, NamesWhatIsBrokenAtMarksAndWalls) {
  const films::FilmComplex sound =
      refined(test_films::sessile_cap_start(1.0), 1);
  test_films::check_complex(sound);
  test_films::check_complex(test_films::double_bubble_start());
  const auto refuses = [&](const auto& breaks) {
    films::FilmComplex broken = sound;
    breaks(broken);
    EXPECT_THROW(test_films::check_complex(broken), MeshError);
  };
  refuses([](films::FilmComplex& c) { c.edges.pop_back(); });
  refuses([](films::FilmComplex& c) { c.edges.push_back(c.edges.front()); });
  refuses([](films::FilmComplex& c) { c.edges[0].a = 1000000; });
  refuses([](films::FilmComplex& c) { c.edges[0].a = c.edges[0].b; });
  refuses([](films::FilmComplex& c) { c.edges[0].constraints = 1; });
  refuses([](films::FilmComplex& c) { c.edges[0].integrals = 7; });
  refuses([](films::FilmComplex& c) { c.constraint_sets[0][0] = 3; });
  refuses([](films::FilmComplex& c) { c.integral_sets[0][0] = -1; });
  refuses([](films::FilmComplex& c) {
    c.edges[0].kind = films::VertexKind::Slides;
  });
  refuses(
      [](films::FilmComplex& c) { c.vertices[c.edges[0].a].constraints = 4; });
  refuses(
      [](films::FilmComplex& c) { c.mesh.points[c.edges[0].a].z() += 1e-3; });
  refuses([](films::FilmComplex& c) {
    c.mesh.facets.push_back(c.mesh.facets[0]);
    c.mesh.facet_label.push_back(c.mesh.facet_label[0]);
  });
  refuses(
      [](films::FilmComplex& c) { c.quantities.push_back({.surfaces = {9}}); });
}

TEST(RemeshLines, SlideAlongTheirCurve) {
  // A disk whose rim slides on its circle, as marked edges say.
  films::FilmComplex complex;
  complex.curves = {{"rim", curves::Circle{}}};
  complex.surfaces = {{.name = "film", .tension = 1.0}};
  complex.mesh.labels = {"film"};
  constexpr int kAround = 24;
  complex.mesh.points = {Vec3::Zero()};
  complex.vertices.resize(1);
  for (int i = 0; i < kAround; ++i) {
    const double t = std::pow(i / double{kAround}, 1.5);
    complex.mesh.points.push_back(curves::point_at(complex.curves[0].shape, t));
    complex.vertices.push_back(
        {.kind = films::VertexKind::Slides, .curve = 0, .t = t});
    const int a = i + 1;
    const int b = i + 1 == kAround ? 1 : i + 2;
    complex.mesh.facets.push_back({0, a, b});
    complex.mesh.facet_label.push_back(0);
    complex.edges.push_back(
        {.a = a, .b = b, .kind = films::VertexKind::Slides, .curve = 0});
  }
  for (const double edge : {0.1, 0.3}) {
    groom::remesh_films(complex, {.edge = edge});
    EXPECT_EQ(systems::euler_characteristic(complex.mesh), 1);
    EXPECT_NEAR(complex.edges.size() * edge, 2.0 * std::numbers::pi,
                0.2 * 2.0 * std::numbers::pi);
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
      const films::ComplexVertex& vertex = complex.vertices[v];
      if (vertex.kind == films::VertexKind::Slides) {
        EXPECT_EQ(complex.mesh.points[v],
                  curves::point_at(complex.curves[0].shape, vertex.t));
      }
    }
    EXPECT_GT(systems::quality(complex, Part::Films).smallest_angle, 25.0);
  }
}

TEST(RemeshLines, AreTheSameInEveryBit) {
  films::FilmComplex once = refined(test_films::cube_frame_start(), 2);
  nonmanifold::shake(once, 0.02, 5);
  films::FilmComplex twice = once;
  groom::remesh_films(once, {.edge = 0.08});
  groom::remesh_films(twice, {.edge = 0.08});
  EXPECT_TRUE(systems::identical(once, twice));
}

TEST(RemeshLines, SurviveRandomShapes) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    films::FilmComplex complex =
        refined(seed % 2 == 0 ? test_films::cube_frame_start()
                              : test_films::tetrahedral_frame_start(),
                2);
    nonmanifold::shake(complex, 0.05 * (1 + seed % 5), seed);
    const auto lines = triple_lines(complex.mesh);
    const int euler = systems::euler_characteristic(complex.mesh);
    groom::remesh_films(complex, {.edge = 0.03 * (2 + seed), .passes = 3});
    EXPECT_EQ(triple_lines(complex.mesh).of_films, lines.of_films);
    EXPECT_EQ(systems::euler_characteristic(complex.mesh), euler);
  }
}

TEST(RemeshGraded, FollowsTheField) {
  films::FilmComplex complex = refined(test_films::triple_disk_start(), 2);
  const auto field = [](const Vec3& p) {
    return 0.04 + 0.12 * std::abs(p.x());
  };
  groom::remesh_films(complex, {.edge_field = field});
  EXPECT_EQ(triple_lines(complex.mesh).of_films.size(), 1U);
  double near = 0.0;
  double off = 0.0;
  std::array<int, 2> counts = {0, 0};
  for (const auto& [edge, facets] : nonmanifold::edge_facets(complex.mesh)) {
    if (complex.vertices[edge[0]].kind != films::VertexKind::Free ||
        complex.vertices[edge[1]].kind != films::VertexKind::Free) {
      continue;
    }
    const Vec3& a = complex.mesh.points[edge[0]];
    const Vec3& b = complex.mesh.points[edge[1]];
    const double ratio = (a - b).norm() / field(0.5 * (a + b));
    EXPECT_LT(ratio, 2.0);
    const bool inside = std::abs(a.x()) < 0.2;
    (inside ? near : off) += ratio;
    ++counts[inside ? 0 : 1];
  }
  EXPECT_NEAR(near / counts[0], 1.0, 0.15);
  EXPECT_NEAR(off / counts[1], 1.0, 0.15);
  EXPECT_THROW(
      groom::remesh_films(complex,
                          {.edge_field = [](const Vec3& p) { return p.x(); }}),
      InvalidInput);
}

TEST(AverageLines, MovesVerticesAlongAStraightLineOnly) {
  // Three fins about the z axis, the line's points unevenly placed.
  films::FilmComplex complex;
  constexpr int kLine = 9;
  for (int i = 0; i < kLine; ++i) {
    complex.mesh.points.emplace_back(0, 0, 0.5 * i + (i % 2 == 1 ? 0.2 : 0.0));
  }
  for (int fin = 0; fin < 3; ++fin) {
    const Vec3 out(std::cos(2.1 * fin), std::sin(2.1 * fin), 0.0);
    const int first = static_cast<int>(complex.mesh.points.size());
    for (int i = 0; i < kLine; ++i) {
      complex.mesh.points.push_back(2.0 * out + Vec3(0, 0, 0.5 * i));
    }
    for (int i = 0; i + 1 < kLine; ++i) {
      complex.mesh.facets.push_back({i, first + i, first + i + 1});
      complex.mesh.facets.push_back({i, first + i + 1, i + 1});
      complex.mesh.facet_label.insert(complex.mesh.facet_label.end(), 2, 0);
    }
  }
  complex.surfaces = {{.name = "fins", .tension = 1.0}};
  complex.mesh.labels = {"fins"};
  complex.vertices.resize(complex.mesh.points.size());
  const double area = surface_area(complex.mesh);
  for (int step = 0; step < 50; ++step) {
    groom::average_vertices(complex);
  }
  for (int i = 0; i < kLine; ++i) {
    EXPECT_NEAR((complex.mesh.points[i] - Vec3(0, 0, 0.5 * i)).norm(), 0.0,
                0.02);
    EXPECT_EQ(complex.mesh.points[i].head<2>(), Eigen::Vector2d::Zero());
  }
  EXPECT_NEAR(surface_area(complex.mesh), area, kLineRounding * area);
  const int flips = groom::equiangulate(complex);
  EXPECT_GE(flips, 0);
  EXPECT_EQ(nonmanifold::count_edges(complex.mesh, 3), kLine - 1);
}

}  // namespace
}  // namespace meniscus::remesh_lines_test
