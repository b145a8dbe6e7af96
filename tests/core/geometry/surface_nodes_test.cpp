#include "core/geometry/surface_nodes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "tests/support/nested_surface.h"
#include "tests/support/shapes.h"

namespace meniscus::surface_nodes_test {
namespace {

constexpr double kNodeRounding = 1e-14;

std::vector<char> marks(const SurfaceMesh& mesh, int every) {
  std::vector<char> marked(mesh.facets.size(), 0);
  for (std::size_t f = 0; f < marked.size();
       f += static_cast<std::size_t>(every)) {
    marked[f] = 1;
  }
  return marked;
}

/// Closed, each label's area and the volume as before, all mid-sides half way:
/// the levels are flat, so a mid-side that is another edge's shows.
void expect_same_shape(const QuadraticSurface& split,
                       const SurfaceMesh& before) {
  EXPECT_TRUE(check_surface(split.base).empty());
  EXPECT_NEAR(enclosed_volume(split.base), enclosed_volume(before),
              kNodeRounding * 100.0);
  for (std::size_t l = 0; l < before.labels.size(); ++l) {
    EXPECT_NEAR(surface_area(split.base, static_cast<int>(l)),
                surface_area(before, static_cast<int>(l)),
                kNodeRounding * 100.0);
  }
  for (std::size_t e = 0; e < split.edges.size(); ++e) {
    const Vec3 half = 0.5 * (split.base.points[split.edges[e][0]] +
                             split.base.points[split.edges[e][1]]);
    EXPECT_NEAR((split.mid[e] - half).norm(), 0.0, kNodeRounding);
  }
  for (std::size_t p = 0; p < before.points.size(); ++p) {
    EXPECT_EQ(split.base.points[p], before.points[p]);
  }
}

TEST(SplitFacets, KeepsTheShapeWithAnyMarks) {
  const SurfaceMesh box = shapes::box({1.0, 2.0, 3.0}, 4);
  for (const int levels : {1, 2}) {
    const NestedSurface nested = nested_surface(box, levels);
    for (const int every : {1, 2, 3, 7, 50}) {
      expect_same_shape(nested.split(marks(box, every)), box);
    }
  }
}

TEST(SplitFacets, AddsPointsNowhereElse) {
  const SurfaceMesh ball = shapes::sphere(1.0, 3);
  const NestedSurface nested = nested_surface(ball, 2);
  std::vector<char> marked(ball.facets.size(), 0);
  EXPECT_EQ(nested.split(marked).base.facets, ball.facets);
  marked[7] = 1;  // one in four, three neighbours in two
  const QuadraticSurface split = nested.split(marked);
  EXPECT_EQ(split.base.facets.size(), ball.facets.size() + 3U + 3U);
  EXPECT_EQ(split.base.points.size(), ball.points.size() + 3U);
}

TEST(SplitFacets, PutsMidSidesOnTheFinestPoints) {
  NestedSurface nested = nested_surface(shapes::sphere(1.0, 2), 2);
  for (Vec3& x : nested.points) {
    x.normalize();  // the levels now bulge
  }
  const QuadraticSurface split = nested.split(marks(shapes::sphere(1.0, 2), 3));
  for (const Vec3& m : split.mid) {
    EXPECT_NEAR(m.norm(), 1.0, kNodeRounding);
  }
  nested.straight.assign(nested.points.size(), 1);
  const QuadraticSurface straight =
      nested.split(marks(shapes::sphere(1.0, 2), 3));
  for (const Vec3& m : straight.mid) {
    EXPECT_LT(m.norm(), 1.0 - 1e-4);
  }
}

TEST(SplitFacets, NeedMiddlesAndMarksThatFit) {
  const SurfaceMesh box = shapes::box({1.0, 1.0, 1.0}, 1);
  EXPECT_THROW(nested_surface(box, 0).split(marks(box, 1)), MeshError);
  EXPECT_THROW(nested_surface(box, 1).split({1, 0}), MeshError);
}

// <A x, y> = <x, A^T y>, split and whole, with curved and straight mid-sides.
TEST(SurfaceNodes, AreTransposed) {
  const SurfaceMesh ball = shapes::sphere(1.0, 2);
  NestedSurface nested = nested_surface(ball, 2);
  for (std::size_t p = 0; p < nested.straight.size(); p += 3) {
    nested.straight[p] = 1;
  }
  const auto wave = [](std::size_t i) {
    const auto x = static_cast<double>(i);
    return Vec3(std::sin(x), std::cos(2.0 * x), std::sin(3.0 * x));
  };
  for (const int every : {7, 1000}) {
    const SurfaceNodes nodes = split_facets(nested.nodes, marks(ball, every),
                                            nested.middles, nested.straight);
    const QuadraticSurface surface = nodes.at(nested.points);
    Points corners;
    Points mid;
    for (std::size_t c = 0; c < surface.base.points.size(); ++c) {
      corners.push_back(wave(c));
    }
    for (std::size_t e = 0; e < surface.mid.size(); ++e) {
      mid.push_back(wave(5 * e));
    }
    const Points back = nodes.transpose(corners, mid, nested.points.size());
    const double there = flat(corners).dot(flat(surface.base.points)) +
                         flat(mid).dot(flat(surface.mid));
    EXPECT_NEAR(flat(back).dot(flat(nested.points)), there,
                kNodeRounding * static_cast<double>(nested.points.size()));
    EXPECT_THROW(nodes.transpose(mid, mid, nested.points.size()), MeshError);
  }
}

}  // namespace
}  // namespace meniscus::surface_nodes_test
