// Quality reports, bounds, and the check after mesh motion.
#include <cmath>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh_tet/mesh_motion.h"
#include "mesh_tet/motion_check.h"
#include "mesh_tet/quadratic.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::quality_test {

namespace {

using ::testing::HasSubstr;

/// One element over a right-angled base, its apex `height` above (1/3, 1/3).
TetMesh cap(double height) {
  TetMesh mesh;
  mesh.nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                Vec3(1.0 / 3.0, 1.0 / 3.0, height)};
  mesh.corner_count = 4;
  mesh.elements = {0, 1, 2, 3};
  mesh.element_region = {0};
  mesh.faces = {0, 2, 1};
  mesh.face_label = {0};
  mesh.face_element = {0};
  mesh.labels = {"base"};
  return mesh;
}

TEST(TetQuality, FindsTheWorstOfEachMeasure) {
  TetMesh mesh = shapes::brick(Vec3(1, 1, 1), 2, 2, 2);
  const mesh_tet::TetQuality regular = mesh_tet::tet_quality(mesh);
  EXPECT_NEAR(regular.min_dihedral_deg, 45.0, 1e-10);
  EXPECT_NEAR(regular.max_dihedral_deg, 90.0, 1e-10);
  const auto& bins = regular.dihedral_histogram;
  EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), 0),
            6 * mesh.element_count());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (mesh.nodes[n] == Vec3(0.5, 0.5, 0.5)) {
      mesh.nodes[n] = Vec3(0.98, 0.97, 0.96);
    }
  }
  const mesh_tet::TetQuality moved = mesh_tet::tet_quality(mesh);
  EXPECT_LT(moved.min_dihedral_deg, 5.0);
  for (const int worst :
       {moved.worst_element, moved.aspect_element, moved.radius_edge_element}) {
    ASSERT_GE(worst, 0);
    ASSERT_LT(worst, mesh.element_count());
  }
  EXPECT_GT(moved.dihedral_histogram[0], 0);
}

TEST(TetQuality, AspectAndRadiusEdgeOfAFlatCap) {
  constexpr double kHeight = 1e-3;
  const mesh_tet::TetQuality quality = mesh_tet::tet_quality(cap(kHeight));
  EXPECT_NEAR(quality.max_aspect, std::sqrt(2.0) / kHeight, 0.01 / kHeight);
  EXPECT_GT(quality.max_radius_edge, 100.0);
  EXPECT_GT(quality.max_dihedral_deg, 179.0);
}

TEST(QualityBounds, NameMeasureValueAndPlace) {
  const TetMesh mesh = cap(0.01);
  const mesh_tet::TetQuality quality = mesh_tet::tet_quality(mesh);
  EXPECT_FALSE(mesh_tet::find_breach(quality, {}));
  const auto flat = mesh_tet::find_breach(quality, {.min_dihedral_deg = 5.0});
  ASSERT_TRUE(flat);
  EXPECT_THAT(flat->what, HasSubstr("least is 5"));
  const auto wide = mesh_tet::find_breach(quality, {.max_dihedral_deg = 170.0});
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->element, 0);
  EXPECT_TRUE(mesh_tet::find_breach(quality, {.max_aspect = 20.0}));
  EXPECT_TRUE(mesh_tet::find_breach(quality, {.max_radius_edge = 5.0}));
  EXPECT_THAT(mesh_tet::place_of(mesh, 0), HasSubstr("'base'"));
  EXPECT_THAT(mesh_tet::place_of(mesh, 0), HasSubstr("(0.333333, 0.333333"));
}

TEST(QualityBounds, MeshesBelowThemAreRefusedWithThePlace) {
  const auto result = mesh_tet::tetrahedralize(
      shapes::sphere(1.0, 2), {.bounds = {.min_dihedral_deg = 40.0}});
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->kind, FailureKind::MeshingFailed);
  EXPECT_THAT(result.failure->message, HasSubstr("the least is 40"));
  EXPECT_THAT(result.failure->message, HasSubstr("near ("));
}

TEST(MotionCheck, SoundMeshesPass) {
  const TetMesh mesh = shapes::brick(Vec3(1, 1, 1), 3, 3, 3);
  mesh_tet::TetQuality quality;
  EXPECT_FALSE(mesh_tet::check_moved(mesh, {}, &quality));
  EXPECT_NEAR(quality.min_dihedral_deg, 45.0, 1e-10);
  EXPECT_FALSE(mesh_tet::check_moved(shapes::straight_quadratic(mesh)));
}

TEST(MotionCheck, NamesWhatIsWrong) {
  const auto expect = [](const TetMesh& mesh, const char* words) {
    const auto failure = mesh_tet::check_moved(mesh);
    ASSERT_TRUE(failure) << words;
    EXPECT_EQ(failure->kind, FailureKind::ElementsInverted);
    EXPECT_THAT(failure->message, HasSubstr(words));
  };
  expect(cap(-0.3), "inside out");
  expect(cap(0.0), "inside out");
  expect(cap(std::numeric_limits<double>::quiet_NaN()), "inside out");
  expect(cap(1e-4), "dihedral angle");
  TetMesh folded =
      shapes::straight_quadratic(shapes::brick(Vec3(1, 1, 1), 1, 1, 1));
  const auto ids = folded.element(2);
  folded.nodes[ids[4]] += 2.0 * (folded.nodes[ids[3]] - folded.nodes[ids[0]]);
  expect(folded, "curved sides");
}

// However far the surface goes, a bad mesh is always told: the check agrees
// with the volumes of sub-tetrahedra that a ten-node element is cut into.
TEST(MotionCheck, NoInvertedElementGoesUnseen) {
  const SurfaceMesh base = shapes::sphere(1.0, 2);
  const auto filled = mesh_tet::tetrahedralize(base);
  ASSERT_FALSE(filled.failure);
  QuadraticSurface surface;
  surface.base = base;
  list_edges(base.facets, surface.edges, surface.facet_edges);
  const auto curve = [&](const Points& points) {
    surface.mid.clear();
    for (const Edge& e : surface.edges) {
      const Vec3 middle = 0.5 * (points[e[0]] + points[e[1]]);
      surface.mid.push_back(1.02 * middle);
    }
  };
  curve(base.points);
  std::vector<char> flags;
  TetMesh mesh = mesh_tet::make_quadratic(filled.mesh, surface, &flags);
  const mesh_tet::MeshMotion motion(filled.mesh,
                                    static_cast<int>(base.points.size()));
  int sound = 0;
  int bad = 0;
  for (int step = 0; step <= 20; ++step) {
    const double amount = 0.2 * step;
    Points moved = base.points;
    for (Vec3& p : moved) {  // bent ever more, into itself at last
      p.z() += amount * p.x() * p.x();
      p.x() *= 1.0 - 0.25 * amount * p.y();
    }
    curve(moved);
    mesh_tet::move_quadratic(mesh, motion.move(moved), surface, flags);
    bool inverted = false;
    for (int e = 0; e < mesh.element_count(); ++e) {
      inverted = inverted || !(corner_volume(mesh, e) > 0.0) ||
                 mesh_tet::jacobian_ratio(mesh, e) < 0.0;
    }
    const auto failure = mesh_tet::check_moved(mesh);
    EXPECT_TRUE(failure || !inverted) << step;
    (failure ? bad : sound) += 1;
  }
  EXPECT_GT(sound, 3);
  EXPECT_GT(bad, 3);
}

}  // namespace

}  // namespace meniscus::quality_test
