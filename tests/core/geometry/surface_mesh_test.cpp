#include "core/geometry/surface_mesh.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/tet_mesh.h"
#include "tests/support/shapes.h"

namespace meniscus::surface_mesh_test {
namespace {

constexpr double kRounding = 1e-13;  // sums of some hundred terms of order 1

TEST(SurfaceMesh, BoxHasItsVolumeAndArea) {
  const SurfaceMesh mesh = shapes::box(Vec3(2, 3, 4), 4);
  EXPECT_NEAR(enclosed_volume(mesh), 24.0, 24 * kRounding);
  EXPECT_NEAR(surface_area(mesh), 52.0, 52 * kRounding);
  EXPECT_NEAR(surface_area(mesh, mesh.label_of("z1")), 6.0, 6 * kRounding);
  EXPECT_EQ(mesh.label_of("lid"), -1);
}

TEST(SurfaceMesh, SphereConvergesAtSecondOrder) {
  const double exact = 4.0 * std::numbers::pi / 3.0;
  const double coarse = exact - enclosed_volume(shapes::sphere(1.0, 3));
  const double fine = exact - enclosed_volume(shapes::sphere(1.0, 4));
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

TEST(SurfaceMesh, ClosedSurfaceHasEveryEdgeTwice) {
  const SurfaceMesh mesh = shapes::box(Vec3(1, 1, 1), 3);
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(mesh.facets, edges, facet_edges);
  // Euler: V - E + F = 2.
  EXPECT_EQ(mesh.points.size() - edges.size() + mesh.facets.size(), 2u);
}

TEST(SurfaceMesh, ListsEdgesByFirstAppearanceAroundHubsToo) {
  // A fan about point 0, three films along its first spoke, a lone facet.
  std::vector<Triangle> facets;
  constexpr int kFan = 200;
  for (int i = 0; i < kFan; ++i) {
    facets.push_back({1 + (i + 1) % kFan, 0, 1 + i});
  }
  facets.push_back({0, 1, kFan + 1});
  facets.push_back({kFan + 4, kFan + 3, kFan + 2});
  std::vector<Edge> edges;
  std::vector<Triangle> facet_edges;
  list_edges(facets, edges, facet_edges);
  std::vector<Edge> expected;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = facets[f][k];
      const int b = facets[f][(k + 1) % 3];
      const Edge edge{std::min(a, b), std::max(a, b)};
      auto at = std::find(expected.begin(), expected.end(), edge);
      if (at == expected.end()) {
        expected.push_back(edge);
        at = expected.end() - 1;
      }
      EXPECT_EQ(facet_edges[f][k], at - expected.begin());
    }
  }
  EXPECT_EQ(edges, expected);
  list_edges({}, edges, facet_edges);
  EXPECT_TRUE(edges.empty());
}

TEST(TetMesh, BrickFillsItsBoxWithOutwardFaces) {
  const TetMesh mesh = shapes::brick(Vec3(2, 1, 3), 2, 3, 4);
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_GT(corner_volume(mesh, e), 0.0);
    volume += corner_volume(mesh, e);
  }
  EXPECT_NEAR(volume, 6.0, 6 * kRounding);
  SurfaceMesh skin;
  skin.points = mesh.nodes;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto ids = mesh.face(f);
    skin.facets.push_back({ids[0], ids[1], ids[2]});
  }
  EXPECT_NEAR(enclosed_volume(skin), 6.0, 6 * kRounding);
}

}  // namespace
}  // namespace meniscus::surface_mesh_test
