#include "mesh_tet/tetrahedralize.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace meniscus::tetrahedralize_test {

namespace {

// Sums of up to 1e5 volumes in double precision.
constexpr double kMesherRounding = 1e-12;

double volume_of(const TetMesh& mesh) {
  double volume = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    volume += corner_volume(mesh, e);
  }
  return volume;
}

/// Appends `part`, its facets turned round when `inward`.
SurfaceMesh joined(SurfaceMesh mesh, const SurfaceMesh& part, const Vec3& shift,
                   bool inward) {
  const int first = static_cast<int>(mesh.points.size());
  for (const Vec3& p : part.points) {
    mesh.points.push_back(p + shift);
  }
  for (const Triangle& t : part.facets) {
    const Triangle ids = {first + t[0], first + t[1], first + t[2]};
    mesh.facets.push_back(inward ? Triangle{ids[0], ids[2], ids[1]} : ids);
    mesh.facet_label.push_back(0);
  }
  return mesh;
}

void expect_fills(const mesh_tet::Tetrahedralization& result,
                  const SurfaceMesh& surface) {
  ASSERT_FALSE(result.failure) << result.failure->message;
  const TetMesh& mesh = result.mesh;
  EXPECT_EQ(mesh.order, 1);
  EXPECT_EQ(mesh.corner_count, static_cast<int>(mesh.nodes.size()));
  EXPECT_EQ(mesh.element_region.size() * 4, mesh.elements.size());
  ASSERT_GE(mesh.nodes.size(), surface.points.size());
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    EXPECT_EQ(mesh.nodes[p], surface.points[p]);
  }
  const double volume = enclosed_volume(surface);
  EXPECT_NEAR(volume_of(mesh), volume, kMesherRounding * volume);
  EXPECT_EQ(mesh.labels, surface.labels);
  EXPECT_EQ(mesh.face_label, surface.facet_label);
  ASSERT_EQ(mesh.face_count(), static_cast<int>(surface.facets.size()));
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto ids = mesh.face(f);
    const auto behind = mesh.element(mesh.face_element[f]);
    Vec3 center = Vec3::Zero();
    for (const int n : behind) {
      center += 0.25 * mesh.nodes[n];
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(ids[k], surface.facets[f][k]);
      EXPECT_NE(std::find(behind.begin(), behind.end(), ids[k]), behind.end());
    }
    EXPECT_LT((center - mesh.nodes[ids[0]]).dot(area_vector2(surface, f)), 0.0);
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    EXPECT_GT(corner_volume(mesh, e), 0.0);
  }
  EXPECT_GE(result.quality.min_dihedral_deg,
            mesh_tet::QualityBounds{}.min_dihedral_deg);
  EXPECT_GT(result.quality.min_volume, 0.0);
}

TEST(Tetrahedralize, FillsBox) {
  const SurfaceMesh surface = shapes::box(Vec3(1, 2, 3), 5);
  expect_fills(mesh_tet::tetrahedralize(surface), surface);
}

TEST(Tetrahedralize, FillsSphereWithGoodElements) {
  const SurfaceMesh surface = shapes::sphere(2.0, 3);
  const mesh_tet::Tetrahedralization result = mesh_tet::tetrahedralize(surface);
  expect_fills(result, surface);
  EXPECT_GT(result.quality.min_dihedral_deg, 10.0);
  EXPECT_LT(result.quality.max_dihedral_deg, 165.0);
}

TEST(Tetrahedralize, ElementsHaveTheSizeOfTheirEdge) {
  const SurfaceMesh surface = shapes::sphere(74.0, 3);
  for (const double edge : {8.0, 16.0}) {
    const auto result = mesh_tet::tetrahedralize(surface, {.edge = edge});
    ASSERT_FALSE(result.failure) << result.failure->message;
    const double mean = enclosed_volume(surface) / result.mesh.element_count();
    // The surface's own edge of 11 counts too.
    const double regular = edge * edge * edge / (6.0 * std::sqrt(2.0));
    EXPECT_GT(mean, 0.5 * regular);
    EXPECT_LT(mean, 1.5 * regular);
  }
}

TEST(Tetrahedralize, CavityAndSecondPart) {
  const SurfaceMesh ball = shapes::sphere(1.0, 2);
  SurfaceMesh surface = shapes::sphere(3.0, 3);
  surface = joined(surface, ball, Vec3(1, 0.5, 0), true);
  expect_fills(mesh_tet::tetrahedralize(surface), surface);
  surface = joined(surface, ball, Vec3(6, 0, 0), false);
  expect_fills(mesh_tet::tetrahedralize(surface), surface);
}

TEST(Tetrahedralize, UnitsDoNotMatter) {
  const SurfaceMesh base = shapes::sphere(1.0, 2);
  const auto expected = mesh_tet::tetrahedralize(base);
  ASSERT_FALSE(expected.failure);
  for (const double factor : {std::exp2(-30), std::exp2(30)}) {
    SurfaceMesh scaled = base;
    for (Vec3& p : scaled.points) {
      p *= factor;
    }
    const auto result = mesh_tet::tetrahedralize(scaled);
    expect_fills(result, scaled);
    EXPECT_EQ(result.mesh.elements, expected.mesh.elements);
  }
}

TEST(Tetrahedralize, SameInputSameBits) {
  const SurfaceMesh surface = shapes::sphere(1.3, 3);
  const auto first = mesh_tet::tetrahedralize(surface);
  const auto second = mesh_tet::tetrahedralize(surface);
  ASSERT_FALSE(first.failure);
  EXPECT_EQ(first.mesh.elements, second.mesh.elements);
  EXPECT_EQ(first.mesh.nodes, second.mesh.nodes);
}

TEST(Tetrahedralize, RefusesOptionsOutOfRange) {
  const SurfaceMesh surface = shapes::sphere(1.0, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const mesh_tet::TetrahedralizeOptions& options :
       {mesh_tet::TetrahedralizeOptions{.edge = 0.0},
        {.edge = nan},
        {.radius_edge_ratio = 0.5},
        {.min_dihedral_deg = 40.0},
        {.time_limit = 0.0},
        {.memory_limit = -1.0}}) {
    EXPECT_THROW(mesh_tet::tetrahedralize(surface, options), InvalidInput);
  }
}

TEST(TetQuality, RegularTetrahedron) {
  TetMesh mesh;
  mesh.nodes = {Vec3(1, 1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1),
                Vec3(-1, -1, 1)};
  mesh.elements = {0, 1, 2, 3};
  const double exact = std::acos(1.0 / 3.0) * 180.0 / M_PI;
  const mesh_tet::TetQuality quality = mesh_tet::tet_quality(mesh);
  EXPECT_NEAR(quality.min_dihedral_deg, exact, 1e-12 * exact);
  EXPECT_NEAR(quality.max_dihedral_deg, exact, 1e-12 * exact);
  EXPECT_NEAR(quality.max_radius_edge, std::sqrt(6.0) / 4.0, kMesherRounding);
  EXPECT_NEAR(quality.max_aspect, std::sqrt(1.5), kMesherRounding);
  EXPECT_NEAR(std::abs(quality.min_volume), 8.0 / 3.0, kMesherRounding);
}

}  // namespace

}  // namespace meniscus::tetrahedralize_test
