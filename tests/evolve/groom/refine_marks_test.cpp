#include <numbers>

#include <gtest/gtest.h>

#include "core/timer.h"
#include "evolve/films/edge_marks.h"
#include "evolve/groom/refine.h"
#include "tests/support/film_complexes.h"
#include "tests/support/nonmanifold_shapes.h"

namespace meniscus::refine_marks_test {
namespace {

constexpr double kMarkRounding = 1e-13;  // sums of a few terms of size 1
constexpr double kGoldenSearch = 1e-7;   // sqrt of rounding, as searches end

const std::vector<std::string> kPlace = {"x", "y", "z"};

// The unit square in z = 0 as two facets, cut from (0, 0) to (1, 1).
films::FilmComplex square() {
  films::FilmComplex complex;
  complex.mesh.points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                         Vec3(0, 1, 0)};
  complex.mesh.facets = {{0, 1, 2}, {0, 2, 3}};
  complex.mesh.facet_label = {0, 0};
  complex.mesh.labels = {"film"};
  complex.vertices.resize(4);
  complex.surfaces = {{.name = "film", .tension = 1.0}};
  return complex;
}

int index_of(const groom::Refinement& fine, std::size_t old, Edge edge) {
  const auto at = std::find(fine.parents.begin(), fine.parents.end(), edge);
  return static_cast<int>(old + (at - fine.parents.begin()));
}

TEST(RefineMarks, HalvesKeepDirectionAndAttributes) {
  films::FilmComplex coarse = square();
  coarse.edges = {{.a = 2, .b = 1, .kind = films::VertexKind::Fixed},
                  {.a = 2, .b = 0, .integrals = 0}};
  coarse.integrals.resize(1);
  coarse.integral_sets = {{0}};
  const groom::Refinement fine = groom::refine(coarse);
  const auto& edges = fine.complex.edges;
  ASSERT_EQ(edges.size(), 4U);
  const int side = index_of(fine, 4, {1, 2});
  const int diagonal = index_of(fine, 4, {0, 2});
  EXPECT_EQ((std::array{edges[0].a, edges[0].b}), (std::array{2, side}));
  EXPECT_EQ((std::array{edges[1].a, edges[1].b}), (std::array{side, 1}));
  EXPECT_EQ((std::array{edges[2].a, edges[2].b}), (std::array{2, diagonal}));
  EXPECT_EQ((std::array{edges[3].a, edges[3].b}), (std::array{diagonal, 0}));
  EXPECT_EQ(edges[1].kind, films::VertexKind::Fixed);
  EXPECT_EQ(edges[3].integrals, 0);
  EXPECT_EQ(fine.complex.vertices[side].kind, films::VertexKind::Fixed);
  EXPECT_EQ(fine.complex.vertices[diagonal].kind, films::VertexKind::Free);
}

TEST(RefineMarks, MiddlesLieOnWallsAndCurves) {
  films::FilmComplex coarse = square();
  coarse.level_sets = {
      {.name = "ball",
       .formula = Expression::parse("(x-2)^2 + (y-1/2)^2 + z^2 - 5/4", kPlace)},
      {.name = "floor", .formula = Expression::parse("z + x*0", kPlace)}};
  coarse.constraint_sets = {{0, 1}};
  coarse.curves = {
      {"arc", curves::Circle{Vec3(0.5, 0.5, 0), Vec3::UnitZ(), std::sqrt(0.5)}},
      {"parabola",
       curves::ParametricCurve{{Expression::parse("t", {"t"}),
                                Expression::parse("t^2/2 + t/2", {"t"}),
                                Expression::parse("t*(1-t)", {"t"})}}}};
  // Point 0 is at t = 0 of the parabola, 2 is its end but is a free vertex.
  coarse.vertices[0] = {
      .kind = films::VertexKind::Slides, .curve = 1, .t = 0.0};
  coarse.vertices[1].constraints = 0;
  coarse.vertices[3] = {
      .kind = films::VertexKind::OnCurve, .curve = 0, .t = 0.375};
  coarse.edges = {
      {.a = 0, .b = 1, .constraints = 0},
      {.a = 2, .b = 3, .kind = films::VertexKind::OnCurve, .curve = 0},
      {.a = 0, .b = 2, .kind = films::VertexKind::Slides, .curve = 1}};
  const groom::Refinement fine = groom::refine(coarse);
  const auto& p = fine.complex.mesh.points;
  const int wall = index_of(fine, 4, {0, 1});
  EXPECT_EQ(fine.complex.vertices[wall].constraints, 0);
  EXPECT_TRUE(fine.complex.vertices[wall].held);
  EXPECT_NEAR((p[wall] - Vec3(2, 0.5, 0)).norm(), std::sqrt(1.25),
              kMarkRounding);
  EXPECT_NEAR(p[wall].z(), 0.0, kMarkRounding);
  const int arc = index_of(fine, 4, {2, 3});
  EXPECT_EQ(fine.complex.vertices[arc].kind, films::VertexKind::OnCurve);
  EXPECT_NEAR((p[arc] - Vec3(0.5, 0.5 + std::sqrt(0.5), 0)).norm(), 0.0,
              kGoldenSearch);
  const int slider = index_of(fine, 4, {0, 2});
  const double t = fine.complex.vertices[slider].t;
  EXPECT_EQ(p[slider], curves::point_at(coarse.curves[1].shape, t));
  const Vec3 tangent(1.0, t + 0.5, 1.0 - 2.0 * t);
  EXPECT_NEAR(tangent.dot(p[slider] - Vec3(0.5, 0.5, 0)), 0.0,
              10 * kGoldenSearch);
}

TEST(RefineMarks, OneSidedWallsHoldOnlyWhatTheyTouch) {
  films::FilmComplex coarse = square();
  coarse.level_sets = {{.name = "above",
                        .formula = Expression::parse("z - x*(1-x)", kPlace),
                        .side = films::LevelSet::Side::AtMost}};
  coarse.constraint_sets = {{0}};
  for (auto& v : coarse.vertices) {
    v.constraints = 0;
  }
  coarse.vertices[3].held = false;
  coarse.edges = {{.a = 0, .b = 1, .constraints = 0},
                  {.a = 2, .b = 3, .constraints = 0}};
  const groom::Refinement fine = groom::refine(coarse);
  const int touching = index_of(fine, 4, {0, 1});
  const int left = index_of(fine, 4, {2, 3});
  const Vec3& p = fine.complex.mesh.points[touching];
  EXPECT_NEAR(p.z() - p.x() * (1 - p.x()), 0.0, kMarkRounding);
  EXPECT_GT(p.z(), 0.1);
  EXPECT_FALSE(fine.complex.vertices[left].held);
  EXPECT_EQ(fine.complex.mesh.points[left], Vec3(0.5, 1.0, 0.0));
}

TEST(RefineMarks, WholeEdgesAndSurfacesStayAndTheRestConforms) {
  for (int whole = 0; whole < 8; ++whole) {
    films::FilmComplex coarse = square();
    const std::array<Edge, 3> sides = {Edge{0, 1}, Edge{1, 2}, Edge{0, 2}};
    for (int k = 0; k < 3; ++k) {
      if ((whole >> k & 1) != 0) {
        coarse.edges.push_back(
            {.a = sides[k][0], .b = sides[k][1], .refine = false});
      }
    }
    const groom::Refinement fine = groom::refine(coarse);
    const int bits = std::popcount(static_cast<unsigned>(whole));
    EXPECT_EQ(fine.parents.size(), 5U - bits);
    const std::size_t expected = (4U - bits) + ((whole & 4) != 0 ? 3U : 4U);
    EXPECT_EQ(fine.complex.mesh.facets.size(), expected);
    EXPECT_NEAR(surface_area(fine.complex.mesh), 1.0, kMarkRounding);
    // The border edges: four sides, halved or whole.
    EXPECT_EQ(nonmanifold::count_edges(fine.complex.mesh, 1),
              8 - (whole & 1) - (whole >> 1 & 1));
    EXPECT_EQ(fine.complex.edges.size(), static_cast<std::size_t>(bits));
  }
  films::FilmComplex coarse = square();
  coarse.surfaces.push_back({.name = "still", .refine = false});
  coarse.mesh.labels.emplace_back("still");
  coarse.mesh.facet_label[1] = 1;
  const films::FilmComplex fine = groom::refine(coarse).complex;
  EXPECT_EQ(fine.mesh.facets.size(), 4U);
  EXPECT_EQ(fine.mesh.facets.back(), coarse.mesh.facets.back());
}

TEST(RefineMarks, NumbersChildrenAsMultigridNeeds) {
  const films::FilmComplex coarse = test_films::cube_frame_start();
  const groom::Refinement fine = groom::refine(coarse);
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(coarse.mesh.facets, edges, facet_edges);
  EXPECT_EQ(fine.parents, edges);
  const int first = static_cast<int>(coarse.mesh.points.size());
  for (std::size_t f = 0; f < coarse.mesh.facets.size(); ++f) {
    const Triangle& t = coarse.mesh.facets[f];
    const int ab = first + facet_edges[f][0];
    const int bc = first + facet_edges[f][1];
    const int ca = first + facet_edges[f][2];
    const auto& made = fine.complex.mesh.facets;
    EXPECT_EQ(made[4 * f], (Triangle{t[0], ab, ca}));
    EXPECT_EQ(made[4 * f + 1], (Triangle{ab, t[1], bc}));
    EXPECT_EQ(made[4 * f + 2], (Triangle{ca, bc, t[2]}));
    EXPECT_EQ(made[4 * f + 3], (Triangle{ab, bc, ca}));
  }
  EXPECT_EQ(nonmanifold::triple_lines(fine.complex.mesh).of_films,
            nonmanifold::triple_lines(coarse.mesh).of_films);
  EXPECT_NEAR(surface_area(fine.complex.mesh), surface_area(coarse.mesh),
              10 * kMarkRounding);
}

TEST(RefineMarks, AWireWithoutFilmsIsHalvedToo) {
  films::FilmComplex coarse = square();
  coarse.mesh.points.emplace_back(2, 0, 0);
  coarse.vertices.push_back({.kind = films::VertexKind::Fixed});
  coarse.edges = {{.a = 1, .b = 4, .kind = films::VertexKind::Fixed}};
  const groom::Refinement fine = groom::refine(coarse);
  EXPECT_EQ(fine.parents.back(), (Edge{1, 4}));
  EXPECT_EQ(fine.complex.mesh.points.back(), Vec3(1.5, 0, 0));
  EXPECT_EQ(fine.complex.edges.size(), 2U);
}

TEST(RefineMarks, IsFast) {
  films::FilmComplex complex = test_films::catenoid_start();
  while (complex.mesh.facets.size() < 245760) {
    complex = groom::refine(complex).complex;
  }
  const Timer timer;
  const groom::Refinement fine = groom::refine(complex);
  RecordProperty("seconds", std::to_string(timer.seconds()));
  EXPECT_EQ(fine.complex.mesh.facets.size(), 983040U);
  constexpr double kLimit = 1.2;  // [s] several times the aim: shared machines
  EXPECT_LT(timer.seconds(), kLimit);
}

TEST(NearestParameter, FindsTheFootOnEveryShape) {
  const Vec3 at(1.5, 0.7, 0.3);
  for (const curves::CurveShape& shape :
       {curves::CurveShape(curves::Circle{}),
        curves::CurveShape(curves::Rectangle{}),
        curves::CurveShape(curves::Ellipse{.radius_1 = 2.0, .radius_2 = 0.5}),
        curves::CurveShape(curves::Polygon{
            {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(3, 3, 1), Vec3(0, 2, 0)}})}) {
    const double t = films::nearest_parameter(shape, at, 0.0);
    const double found = (curves::point_at(shape, t) - at).norm();
    for (int i = 0; i < 1000; ++i) {
      EXPECT_GE((curves::point_at(shape, i / 1000.0) - at).norm(),
                found - 1e-9);
    }
  }
}

}  // namespace
}  // namespace meniscus::refine_marks_test
