// Several bodies in one surface, cavities, and what is made from them.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "mesh_tet/jacobian.h"
#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::bodies_test {

namespace {

// Sums of up to 1e5 volumes in double precision.
constexpr double kRounding = 1e-12;

std::vector<double> region_volumes(const TetMesh& mesh) {
  std::vector<double> volumes;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto region = static_cast<std::size_t>(mesh.element_region[e]);
    volumes.resize(std::max(volumes.size(), region + 1), 0.0);
    volumes[region] += corner_volume(mesh, e);
  }
  return volumes;
}

/// Every facet is a face with the elements of its two bodies on its sides.
void expect_bodies(const SurfaceMesh& surface, const TetMesh& mesh,
                   const std::vector<double>& volumes) {
  const std::vector<double> found = region_volumes(mesh);
  ASSERT_EQ(found.size(), volumes.size());
  for (std::size_t b = 0; b < volumes.size(); ++b) {
    EXPECT_NEAR(found[b], volumes[b], kRounding * volumes[b]) << b;
  }
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    EXPECT_EQ(mesh.nodes[p], surface.points[p]);
  }
  ASSERT_EQ(mesh.face_count(), static_cast<int>(surface.facets.size()));
  ASSERT_EQ(mesh.face_front.size(), surface.facets.size());
  for (int f = 0; f < mesh.face_count(); ++f) {
    const FacetBodies& bodies = surface.facet_bodies[f];
    EXPECT_EQ(mesh.element_region[mesh.face_element[f]], bodies.behind);
    const int front = mesh.face_front[f];
    EXPECT_EQ(front < 0 ? -1 : mesh.element_region[front], bodies.front);
  }
}

TEST(Bodies, TwoHalvesShareTheirInterface) {
  const SurfaceMesh surface =
      shapes::cubes({2, 1, 1}, 4, [](int i, int, int) { return i; });
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(result.failure) << result.failure->message;
  expect_bodies(surface, result.mesh, {1.0, 1.0});
}

TEST(Bodies, EightMeetAtAPoint) {
  const SurfaceMesh surface = shapes::cubes(
      {2, 2, 2}, 3, [](int i, int j, int k) { return 4 * i + 2 * j + k; });
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(result.failure) << result.failure->message;
  expect_bodies(surface, result.mesh, std::vector<double>(8, 1.0));
}

TEST(Bodies, CoreInAHollowInABody) {
  // Body 1 in body 0, a cavity beside it, and a cavity between the two.
  const SurfaceMesh surface =
      shapes::cubes({5, 3, 3}, 2, [](int i, int j, int k) {
        if (j != 1 || k != 1 || i == 0 || i == 4) {
          return 0;
        }
        return i == 2 ? -1 : i == 1 ? 1 : 2;
      });
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(result.failure) << result.failure->message;
  expect_bodies(surface, result.mesh, {42.0, 1.0, 1.0});
}

TEST(Bodies, ApartAndFloating) {
  const SurfaceMesh surface =
      shapes::cubes({7, 5, 5}, 1, [](int i, int j, int k) {
        const auto ring = [](int a) { return std::min(a, 4 - a); };
        if (i == 5) {
          return -1;
        }
        if (i == 6) {
          return 2;
        }
        const int depth = std::min({ring(i), ring(j), ring(k)});
        return depth == 0 ? 0 : depth == 1 ? -1 : 1;  // 1 floats in a cavity
      });
  const auto result = mesh_tet::tetrahedralize(surface, {.edge = 1.0});
  ASSERT_FALSE(result.failure) << result.failure->message;
  expect_bodies(surface, result.mesh, {98.0, 1.0, 25.0});
}

TEST(Bodies, RandomCubes) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> draw(-1, 4);
  int filled = 0;
  for (int trial = 0; trial < 30; ++trial) {
    std::array<int, 8> body{};
    for (int& b : body) {
      b = draw(random);
    }
    const SurfaceMesh surface =
        shapes::cubes({2, 2, 2}, 2, [&](int i, int j, int k) {
          return body[static_cast<std::size_t>(4 * i + 2 * j + k)];
        });
    const auto result = mesh_tet::tetrahedralize(surface);
    if (result.failure) {  // bodies that touch themselves along an edge
      EXPECT_EQ(result.failure->kind, FailureKind::SurfaceInvalid);
      ASSERT_FALSE(result.findings.empty());
      EXPECT_EQ(result.findings[0].kind, FindingKind::NonManifoldEdge)
          << result.failure->message;
      continue;
    }
    ++filled;
    std::vector<double> volumes(body_count(surface), 0.0);
    for (const int b : body) {
      if (b >= 0) {
        volumes[b] += 1.0;
      }
    }
    expect_bodies(surface, result.mesh, volumes);
  }
  EXPECT_GT(filled, 5);
}

TEST(Bodies, OnesThatDisagreeAreRefused) {
  SurfaceMesh surface =
      shapes::cubes({2, 1, 1}, 2, [](int i, int, int) { return i; });
  surface.facet_bodies[3].behind = 5;
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->kind, FailureKind::SurfaceInvalid);
  EXPECT_FALSE(result.findings.empty());
}

/// A ball, radius 2, around a core, radius 1.
SurfaceMesh ball_with_core(int levels) {
  SurfaceMesh surface = shapes::sphere(2.0, levels);
  surface.facet_bodies.assign(surface.facets.size(), {0, -1});
  const SurfaceMesh core = shapes::sphere(1.0, levels - 1);
  const int first = static_cast<int>(surface.points.size());
  surface.points.insert(surface.points.end(), core.points.begin(),
                        core.points.end());
  for (const Triangle& t : core.facets) {
    surface.facets.push_back({first + t[0], first + t[1], first + t[2]});
    surface.facet_label.push_back(1);
    surface.facet_bodies.push_back({1, 0});
  }
  surface.labels.emplace_back("core");
  return surface;
}

/// Of curved ten-node elements.
double region_volume(const TetMesh& mesh, int region) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    std::array<Vec3, 10> x;
    for (int n = 0; n < 10; ++n) {
      x[n] = mesh.nodes[mesh.element(e)[n]];
    }
    if (mesh.element_region[e] == region) {
      volume += mesh_tet::mean_determinant(mesh_tet::corner_jacobians(x)) / 6.0;
    }
  }
  return volume;
}

TEST(Bodies, TenNodeElementsCurveAtTheInterfaceToo) {
  constexpr double kExact = 4.0 / 3.0 * M_PI;  // of the core
  std::array<double, 2> error{};
  for (int level = 0; level < 2; ++level) {
    QuadraticSurface curved;
    curved.base = ball_with_core(level + 2);
    list_edges(curved.base.facets, curved.edges, curved.facet_edges);
    for (const Edge& e : curved.edges) {
      const Vec3& a = curved.base.points[e[0]];
      curved.mid.push_back(a.norm() *
                           (a + curved.base.points[e[1]]).normalized());
    }
    const auto result = mesh_tet::tetrahedralize(curved.base);
    ASSERT_FALSE(result.failure) << result.failure->message;
    int straightened = -1;
    const TetMesh mesh =
        mesh_tet::make_quadratic(result.mesh, curved, nullptr, &straightened);
    // Of elements between two curved surfaces, a few on the coarse ball.
    EXPECT_LT(straightened, level == 0 ? 10 : 1);
    EXPECT_EQ(mesh_tet::find_inverted(mesh), -1);
    EXPECT_EQ(mesh.element_region, result.mesh.element_region);
    EXPECT_EQ(mesh.face_front, result.mesh.face_front);
    error[level] = std::abs(region_volume(mesh, 1) - kExact);
  }
  EXPECT_GT(std::log2(error[0] / error[1]), 3.5);
  RecordProperty("rate", std::to_string(std::log2(error[0] / error[1])));
}

TEST(Bodies, MotionCarriesTheInterface) {
  const SurfaceMesh surface = ball_with_core(3);
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(result.failure) << result.failure->message;
  const mesh_tet::MeshMotion motion(result.mesh,
                                    static_cast<int>(surface.points.size()));
  SurfaceMesh moved = surface;
  for (std::size_t p = 642; p < moved.points.size(); ++p) {
    moved.points[p].x() += 0.3;  // the core alone
  }
  TetMesh mesh = result.mesh;
  mesh.nodes = motion.move(moved.points);
  EXPECT_EQ(mesh_tet::find_inverted(mesh), -1);
  const std::vector<double> before = region_volumes(result.mesh);
  const std::vector<double> after = region_volumes(mesh);
  EXPECT_NEAR(after[0], before[0], kRounding * before[0]);
  EXPECT_NEAR(after[1], before[1], kRounding * before[0]);
}

}  // namespace

}  // namespace meniscus::bodies_test
