// Elements of the size asked for, place by place.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::size_field_test {

namespace {

Vec3 centroid(const TetMesh& mesh, int e) {
  Vec3 sum = Vec3::Zero();
  for (const int n : mesh.element(e)) {
    sum += 0.25 * mesh.nodes[n];
  }
  return sum;
}

/// Edge of the regular tetrahedron of the element's volume.
double edge_of(const TetMesh& mesh, int e) {
  return std::cbrt(6.0 * std::sqrt(2.0) * corner_volume(mesh, e));
}

/// Sorted ratios of the edges of elements to the size asked for at their
/// centroids, of the elements in `part`.
template <class Part>
std::vector<double> ratios(const TetMesh& mesh,
                           const mesh_tet::EdgeAtPlace& size, Part part) {
  std::vector<double> result;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Vec3 at = centroid(mesh, e);
    if (part(at)) {
      result.push_back(edge_of(mesh, e) / size(at));
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

double quantile(const std::vector<double>& sorted, double part) {
  return sorted[static_cast<std::size_t>(
      part * static_cast<double>(sorted.size() - 1))];
}

void expect_size(const std::vector<double>& ratio) {
  ASSERT_FALSE(ratio.empty());
  for (const int percent : {5, 50, 99}) {
    ::testing::Test::RecordProperty(
        "p" + std::to_string(percent),
        std::to_string(quantile(ratio, 0.01 * percent)));
  }
  EXPECT_GT(quantile(ratio, 0.5), 0.75);
  EXPECT_LT(quantile(ratio, 0.5), 1.25);
  EXPECT_GT(quantile(ratio, 0.05), 0.4);
  EXPECT_LT(quantile(ratio, 0.99), 1.7);
}

/// Fine at (0.3, 0, 0), growing by a quarter of the distance.
double cone(const Vec3& x) {
  return std::min(0.3, 0.04 + 0.25 * (x - Vec3(0.3, 0, 0)).norm());
}

TEST(SizeField, IsMetInsideABall) {
  // The surface's edge is 0.15: elements beside it follow that.
  const SurfaceMesh surface = shapes::sphere(1.0, 3);
  const auto result = mesh_tet::tetrahedralize(surface, {.size = cone});
  ASSERT_FALSE(result.failure) << result.failure->message;
  expect_size(
      ratios(result.mesh, cone, [](const Vec3& x) { return x.norm() < 0.75; }));
  EXPECT_GT(result.quality.min_dihedral_deg, 10.0);
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    ASSERT_EQ(result.mesh.nodes[p], surface.points[p]);
  }
}

TEST(SizeField, IsMetInEveryUnit) {
  const double unit = 1e-7;
  SurfaceMesh surface = shapes::sphere(unit, 2);
  for (Vec3& p : surface.points) {
    p += 30.0 * unit * Vec3(1, -1, 1);
  }
  const auto size = [&](const Vec3& x) {
    return unit * (0.08 + 0.2 * std::abs(x.x() / unit - 30.0));
  };
  const auto result = mesh_tet::tetrahedralize(surface, {.size = size});
  ASSERT_FALSE(result.failure) << result.failure->message;
  expect_size(ratios(result.mesh, size, [&](const Vec3& x) {
    return (x - 30.0 * unit * Vec3(1, -1, 1)).norm() < 0.6 * unit;
  }));
}

TEST(SizeField, WorksAcrossBodiesAndAroundCavities) {
  const SurfaceMesh surface =
      shapes::cubes({4, 3, 3}, 2, [](int i, int j, int k) {
        return i == 1 && j == 1 && k == 1 ? -1 : i / 2;
      });
  const auto size = [](const Vec3& x) {
    return 0.12 + 0.4 * std::abs(x.x() - 2.5);
  };
  const auto result = mesh_tet::tetrahedralize(surface, {.size = size});
  ASSERT_FALSE(result.failure) << result.failure->message;
  std::array<double, 2> volumes{};
  for (int e = 0; e < result.mesh.element_count(); ++e) {
    volumes.at(result.mesh.element_region[e]) += corner_volume(result.mesh, e);
  }
  EXPECT_NEAR(volumes[0], 17.0, 1e-10);
  EXPECT_NEAR(volumes[1], 18.0, 1e-10);
  expect_size(ratios(result.mesh, size, [](const Vec3& x) {
    return std::abs(x.x() - 2.5) < 0.4 && std::abs(x.y() - 1.5) < 1.0 &&
           std::abs(x.z() - 1.5) < 1.0;
  }));
}

TEST(SizeField, EdgeIsTheUpperBound) {
  const SurfaceMesh surface = shapes::sphere(1.0, 3);
  const auto constant = [](const Vec3&) { return 10.0; };
  const auto coarse = mesh_tet::tetrahedralize(surface, {.size = constant});
  const auto fine =
      mesh_tet::tetrahedralize(surface, {.edge = 0.1, .size = constant});
  ASSERT_FALSE(coarse.failure);
  ASSERT_FALSE(fine.failure);
  EXPECT_GT(fine.mesh.element_count(), 3 * coarse.mesh.element_count());
}

TEST(SizeField, RepeatsBitForBit) {
  const SurfaceMesh surface = shapes::sphere(1.0, 2);
  const auto first = mesh_tet::tetrahedralize(surface, {.size = cone});
  const auto second = mesh_tet::tetrahedralize(surface, {.size = cone});
  ASSERT_FALSE(first.failure);
  EXPECT_EQ(first.mesh.elements, second.mesh.elements);
  EXPECT_EQ(first.mesh.nodes, second.mesh.nodes);
}

TEST(SizeField, RefusesSizesThatAreNone) {
  const SurfaceMesh surface = shapes::sphere(1.0, 2);
  for (const double bad :
       {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto size = [&](const Vec3& x) { return x.x() > 0.5 ? bad : 0.3; };
    EXPECT_THROW(mesh_tet::tetrahedralize(surface, {.size = size}),
                 InvalidInput);
  }
  const auto tiny = [](const Vec3&) { return 1e-5; };
  const auto result = mesh_tet::tetrahedralize(surface, {.size = tiny});
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->kind, FailureKind::MeshingFailed);
}

TEST(RefineTets, SplitsWhereAsked) {
  const SurfaceMesh surface = shapes::sphere(1.0, 3);
  const auto coarse = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(coarse.failure);
  std::vector<double> edge;
  for (const Vec3& p : coarse.mesh.nodes) {
    edge.push_back((p - Vec3(0.2, 0.1, 0)).norm() < 0.4 ? 0.05 : 1.0);
  }
  const auto fine = mesh_tet::refine_tets(surface, coarse.mesh, edge);
  ASSERT_FALSE(fine.failure) << fine.failure->message;
  const auto inside = [](const Vec3& x) {
    return (x - Vec3(0.2, 0.1, 0)).norm() < 0.35;
  };
  const auto asked = [](const Vec3&) { return 0.05; };
  const std::vector<double> ratio = ratios(fine.mesh, asked, inside);
  EXPECT_GT(quantile(ratio, 0.5), 0.6);
  EXPECT_LT(quantile(ratio, 0.99), 1.5);
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    ASSERT_EQ(fine.mesh.nodes[p], surface.points[p]);
  }
  EXPECT_EQ(fine.mesh.face_label, coarse.mesh.face_label);
  EXPECT_GE(fine.quality.min_dihedral_deg, 5.0);
}

TEST(RefineTets, RefusesWhatDoesNotFit) {
  const SurfaceMesh surface = shapes::sphere(1.0, 1);
  const auto result = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(result.failure);
  std::vector<double> edge(result.mesh.nodes.size(), 0.1);
  EXPECT_THROW(mesh_tet::refine_tets(shapes::sphere(1.0, 2), result.mesh, edge),
               InvalidInput);
  edge[3] = 0.0;
  EXPECT_THROW(mesh_tet::refine_tets(surface, result.mesh, edge), InvalidInput);
  edge.pop_back();
  EXPECT_THROW(mesh_tet::refine_tets(surface, result.mesh, edge), InvalidInput);
}

}  // namespace

}  // namespace meniscus::size_field_test
