#include "report/render/surface_patch.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace meniscus::surface_patch_test {
namespace {

const Vec3 kEye(0.26, -1.0, 0.62);

/// Whether the open stretch between two points crosses the surface.
bool crosses(const SurfaceMesh& mesh, const Vec3& a, const Vec3& b) {
  const Vec3 along = (b - a).normalized();
  const double length = (b - a).norm();
  for (const double hit : render::crossings(mesh, a, along)) {
    if (hit > 1e-9 && hit < length - 1e-9) {
      return true;
    }
  }
  return false;
}

TEST(SurfacePatch, ArrowsLieOutsideThePart) {
  const SurfaceMesh box = shapes::box(Vec3(10, 4, 6), 3);
  for (const char* name : {"x0", "x1", "y0", "y1", "z0", "z1"}) {
    const render::SurfacePatch patch = render::surface_patch(box, name);
    ASSERT_TRUE(patch.found());
    EXPECT_FALSE(patch.is_round());
    EXPECT_NEAR(patch.flatness, 1.0, 1e-12);
    const render::Anchor anchor = render::anchor_of(patch, kEye);
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0.6, 0.8),
                              Vec3(0, 0, -1), Vec3(0, -1, 0)}) {
      const auto arrow = render::place_arrow(box, anchor, along, 2.0, 0.05);
      EXPECT_NEAR((arrow.tip - arrow.tail).norm(), 2.0, 1e-12);
      EXPECT_GT((arrow.tip - arrow.tail).dot(along), 1.9);
      EXPECT_FALSE(crosses(box, arrow.tail, arrow.tip)) << name;
      const Vec3 middle = 0.5 * (arrow.tail + arrow.tip);
      EXPECT_EQ(
          render::crossings(box, middle, Vec3(0.31, 0.62, 0.72)).size() % 2, 0U)
          << name << ": its middle is inside";
    }
  }
}

// Across a bore a force acts at its mouth, before the eye.
TEST(SurfacePatch, ABoreIsActedOnAtItsMouth) {
  SurfaceMesh bore;
  bore.labels = {"bore"};
  constexpr int kSides = 24;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2.0 * EIGEN_PI * k / kSides;
    for (const double y : {-6.0, 6.0}) {
      bore.points.emplace_back(3 * std::cos(angle), y, 3 * std::sin(angle));
    }
  }
  for (int k = 0; k < kSides; ++k) {
    const int a = 2 * k;
    const int b = 2 * ((k + 1) % kSides);
    bore.facets.push_back({a, b, b + 1});
    bore.facets.push_back({a, b + 1, a + 1});
    bore.facet_label.insert(bore.facet_label.end(), {0, 0});
  }
  const render::SurfacePatch patch = render::surface_patch(bore, "bore");
  EXPECT_TRUE(patch.is_round());
  EXPECT_NEAR(std::abs(patch.axis.y()), 1.0, 1e-9);
  const render::Anchor anchor = render::anchor_of(patch, kEye);
  EXPECT_LT(anchor.at.y(), 0.0);
  EXPECT_GT(anchor.out.dot(kEye), 0.0);
  EXPECT_NEAR(anchor.at.x(), 0.0, 1e-9);
}

TEST(SurfacePatch, ArrowsOffTheSurfaceLieOutsideThePart) {
  const SurfaceMesh box = shapes::box(Vec3(10, 10, 10), 4);  // from the origin
  const Vec3 beside(12.5, 4.1, 5.3);
  const render::ArrowPlace away = render::place_free_arrow(
      box, beside, Vec3::UnitX(), Vec3::UnitZ(), 4.0, 0.1);
  EXPECT_EQ(away.tail, beside);
  EXPECT_LT((away.tip - Vec3(16.5, 4.1, 5.3)).norm(), 1e-12);
  // The part is ahead: the arrow ends there.
  const render::ArrowPlace towards = render::place_free_arrow(
      box, beside, -Vec3::UnitX(), Vec3::UnitZ(), 4.0, 0.1);
  EXPECT_EQ(towards.tip, beside);
  EXPECT_LT((towards.tail - Vec3(16.5, 4.1, 5.3)).norm(), 1e-12);
  // Within the part: beyond it.
  const render::ArrowPlace within = render::place_free_arrow(
      box, Vec3(5.2, 4.1, 5.3), Vec3::UnitX(), Vec3::UnitZ(), 4.0, 0.1);
  EXPECT_GT(within.tail.x(), 10.0);
  EXPECT_GT(within.tip.x(), within.tail.x());
  // The part hides it: as far along as the eye needs.
  const render::ArrowPlace hidden = render::place_free_arrow(
      box, beside, Vec3::UnitZ(), -Vec3::UnitX(), 4.0, 0.1);
  EXPECT_GT(hidden.tail.z(), 10.0);
  EXPECT_LT(hidden.tail.z(), 12.0);
  EXPECT_EQ(hidden.tail.x(), 12.5);
}

TEST(SurfacePatch, FacetsAreSpreadEvenly) {
  const SurfaceMesh box = shapes::box(Vec3(10, 10, 10), 12);
  const render::SurfacePatch patch = render::surface_patch(box, "z1");
  const std::vector<int> some = render::spread_facets(box, patch, 2.0, 500);
  EXPECT_GT(some.size(), 12U);
  EXPECT_LT(some.size(), 60U);
  for (std::size_t a = 0; a < some.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_GT((render::facet_middle(box, some[a]) -
                 render::facet_middle(box, some[b]))
                    .norm(),
                2.0);
    }
  }
  EXPECT_EQ(render::spread_facets(box, patch, 0.1, 7).size(), 7U);
  EXPECT_FALSE(render::surface_patch(box, "absent").found());
}

}  // namespace
}  // namespace meniscus::surface_patch_test
