// Level sets of known shapes.
#include "evolve/spines/isosurface.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"

namespace meniscus::isosurface_test {
namespace {

double ball(const Vec3& x) { return 1.0 - (x - Vec3(0.1, 0.2, 0.3)).norm(); }

bool nothing(const Vec3& /*x*/) { return false; }

SurfaceMesh ball_of(double cell) {
  return spines::isosurface(ball, {{Vec3(0.1, 0.2, 0.3), 1.3}}, cell, nothing);
}

TEST(Isosurface, OfABallIsClosedAndComesNearAsTheSquare) {
  const double volume = 4.0 / 3.0 * std::numbers::pi;
  double before = 0.0;
  for (const double cell : {0.2, 0.1, 0.05}) {
    const SurfaceMesh mesh = ball_of(cell);
    EXPECT_TRUE(check_surface(mesh).empty()) << cell;
    const double error = std::abs(enclosed_volume(mesh) - volume) / volume;
    if (before > 0.0) {
      EXPECT_GT(before / error, 3.3);
    }
    before = error;
  }
  EXPECT_LT(before, 2e-3);
}

TEST(Isosurface, EndsWhereItIsLeftOut) {
  const SurfaceMesh mesh =
      spines::isosurface(ball, {{Vec3(0.1, 0.2, 0.3), 1.3}}, 0.1,
                         [](const Vec3& x) { return x.z() > 0.55; });
  // One border, all of it near the plane.
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  std::vector<int> uses(edges.size(), 0);
  for (const Triangle& t : facet_edges) {
    for (const int e : t) {
      ++uses[e];
    }
  }
  int border = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    EXPECT_LE(uses[e], 2);
    if (uses[e] == 1) {
      ++border;
      EXPECT_NEAR(mesh.points[edges[e][0]].z(), 0.5, 0.11);
    }
  }
  EXPECT_GT(border, 20);
  EXPECT_EQ(static_cast<int>(mesh.points.size()) -
                static_cast<int>(edges.size()) +
                static_cast<int>(mesh.facets.size()),
            1);  // a disk
}

TEST(Isosurface, RefusesTooManyCells) {
  EXPECT_THROW(spines::isosurface(ball, {{Vec3::Zero(), 1.3}}, 1e-3, nothing),
               InvalidInput);
}

}  // namespace
}  // namespace meniscus::isosurface_test
