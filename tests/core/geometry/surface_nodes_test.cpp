#include "core/geometry/surface_nodes.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

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

/// The least of the normal area, sampled all over each facet, over its mean.
double least_sampled_area(const QuadraticSurface& surface, std::size_t facet) {
  constexpr int kSteps = 12;
  const Triangle& c = surface.base.facets[facet];
  const Triangle& e = surface.facet_edges[facet];
  const auto at = [&](double u, double v) -> Vec3 {
    const double w = 1.0 - u - v;
    return w * (2.0 * w - 1.0) * surface.base.points[c[0]] +
           u * (2.0 * u - 1.0) * surface.base.points[c[1]] +
           v * (2.0 * v - 1.0) * surface.base.points[c[2]] +
           4.0 * w * u * surface.mid[e[0]] + 4.0 * u * v * surface.mid[e[1]] +
           4.0 * v * w * surface.mid[e[2]];
  };
  constexpr double kStep = 1e-3;
  const Vec3 flat =
      (at(1.0, 0.0) - at(0.0, 0.0)).cross(at(0.0, 1.0) - at(0.0, 0.0));
  double least = 1.0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps;
      const double v = static_cast<double>(j) / kSteps;
      const Vec3 by_u = (at(u + kStep, v) - at(u - kStep, v)) / (2.0 * kStep);
      const Vec3 by_v = (at(u, v + kStep) - at(u, v - kStep)) / (2.0 * kStep);
      least = std::min(least, by_u.cross(by_v).dot(flat) / flat.squaredNorm());
    }
  }
  return least;
}

TEST(StraightenFolded, LeavesNoFoldAndSoundFacetsAlone) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-1.0, 1.0);
  int folded_before = 0;
  for (const double size : {0.02, 0.15, 0.3}) {
    NestedSurface nested = nested_surface(shapes::sphere(1.0, 2), 1);
    const SurfaceNodes before = nested.nodes;
    for (const int mid : before.mid) {
      nested.points[mid] +=
          size * Vec3(shift(random), shift(random), shift(random));
    }
    const QuadraticSurface curved = nested.surface();
    const int count = straighten_folded(nested.nodes, nested.points);
    const QuadraticSurface mended = nested.surface();
    std::vector<char> straight(before.edges.size(), 0);
    int straightened = 0;
    for (std::size_t e = 0; e < straight.size(); ++e) {
      straight[e] = nested.nodes.mid[e] < 0 ? 1 : 0;
      straightened += straight[e];
      EXPECT_TRUE(straight[e] != 0 || nested.nodes.mid[e] == before.mid[e]);
    }
    EXPECT_EQ(count, straightened);
    std::vector<char> asked(straight.size(), 0);
    for (std::size_t f = 0; f < before.mesh.facets.size(); ++f) {
      folded_before += least_sampled_area(curved, f) <= 0.0 ? 1 : 0;
      EXPECT_GT(least_sampled_area(mended, f), 0.0) << "facet " << f;
      const Triangle& edges = before.facet_edges[f];
      if (straight[edges[0]] + straight[edges[1]] + straight[edges[2]] == 3) {
        asked[edges[0]] = asked[edges[1]] = asked[edges[2]] = 1;
      }
    }
    EXPECT_EQ(asked, straight);  // none but those of facets that are now flat
    if (size < 0.05) {
      EXPECT_EQ(count, 0);
    }
  }
  EXPECT_GT(folded_before, 100);
}

}  // namespace
}  // namespace meniscus::surface_nodes_test
