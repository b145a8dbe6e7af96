#include "report/render/render_data.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/vtk_files.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::render_data_test {
namespace {

constexpr double kDataRounding = 1e-12;

TEST(RenderData, RimsAreTheEdgesBetweenSurfaces) {
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 4);
  EXPECT_EQ(render::rim_edges(box).size(), 12u * 4u);
  EXPECT_TRUE(render::rim_edges(shapes::sphere(1.0, 1)).empty());
  SurfaceMesh open = shapes::sphere(1.0, 1);
  open.facets.pop_back();
  open.facet_label.pop_back();
  EXPECT_EQ(render::rim_edges(open).size(), 3u);
}

TEST(RenderData, HiddenSurfacesAreGoneWithTheirPoints) {
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 2);
  EXPECT_EQ(render::without(box, {}).points, box.points);
  const SurfaceMesh open = render::without(box, {"z1"});
  EXPECT_EQ(open.facets.size(), box.facets.size() * 5 / 6);
  EXPECT_EQ(open.points.size(), box.points.size() - 1);  // the lid's middle
  EXPECT_NEAR(surface_area(open), surface_area(box) - 2.0, kDataRounding);
  const SurfaceMesh tube = render::without(box, {"z*"});
  EXPECT_NEAR(surface_area(tube), surface_area(box) - 4.0, kDataRounding);
  EXPECT_EQ(render::rim_edges(tube).size(), 12u * 2u);
  EXPECT_TRUE(render::without(box, {"*"}).points.empty());
}

TEST(RenderData, CuttingOpenLeavesAClosedHalf) {
  const TempFolder folder;
  const TetMesh mesh =
      shapes::straight_quadratic(shapes::brick(Vec3(2, 4, 1), 2, 4, 2));
  io::write_vtu(folder / "part.vtu", mesh);
  const picture::PictureTets tets =
      render::load_tets((folder / "part.vtu").string());
  EXPECT_EQ(static_cast<int>(tets.corners.size()), mesh.element_count());
  const SurfaceMesh half =
      render::cut_open(tets, {.normal = Vec3(0, -1, 0), .level = -2.0});
  EXPECT_NEAR(enclosed_volume(half), 4.0, kDataRounding);
  EXPECT_NEAR(surface_area(half, 1), 2.0, kDataRounding);
}

/// Two flat bars that meet in an L in the plane across `thin`.
picture::PictureTets ell(int thin) {
  picture::PictureTets tets;
  const auto add = [&](const Vec3& low, const Vec3& size) {
    const TetMesh bar = shapes::brick(size, 8, 8, 8);
    const int first = static_cast<int>(tets.nodes.size());
    for (const Vec3& p : bar.nodes) {
      tets.nodes.emplace_back(p + low);
    }
    for (int e = 0; e < bar.element_count(); ++e) {
      const auto n = bar.element(e);
      tets.corners.push_back(
          {first + n[0], first + n[1], first + n[2], first + n[3]});
    }
  };
  const auto sides = [&](double along, double across) {
    Vec3 size(across, across, across);
    size[thin] = 6.0;
    size[(thin + 1) % 3] = along;
    return size;
  };
  Vec3 corner = Vec3::Zero();
  add(corner, sides(100.0, 20.0));
  Vec3 upright = sides(20.0, 100.0);
  upright[(thin + 1) % 3] = 20.0;
  add(corner + 20.0 * Vec3::Unit((thin + 2) % 3), upright);
  return tets;
}

// Whichever way the L lies, both arms are laid open.
TEST(RenderData, AnLIsCutAlongBothArms) {
  const Vec3 view(0.26, -1.0, 0.62);
  for (const int thin : {1, 2}) {
    const picture::PictureTets tets = ell(thin);
    const render::CutPlane plane = render::cut_plane(tets, view);
    EXPECT_GT(std::abs(plane.normal[thin]), 0.99) << thin;
    EXPECT_GT(plane.normal.dot(view), 0.0);
    const SurfaceMesh left = render::cut_open(tets, plane);
    EXPECT_GT(surface_area(left, 1), 0.9 * (100 * 20 + 100 * 20)) << thin;
  }
}

TEST(RenderData, ReadsWhatWasWritten) {
  const TempFolder folder;
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 2);
  io::MeshFields fields;
  fields.points = {{"displacement", "mm", 3, {}}, {"von_mises", "MPa", 1, {}}};
  io::Field& u = fields.points[0];
  io::Field& s = fields.points[1];
  for (const Vec3& p : box.points) {
    u.values.insert(u.values.end(), {p.x(), 0.0, -1.0});
    s.values.push_back(p.z());
  }
  io::write_vtp(folder / "s.vtp", box, fields);
  const picture::PictureSurface surface =
      render::load_surface((folder / "s.vtp").string());
  EXPECT_EQ(surface.mesh.facets, box.facets);
  EXPECT_EQ(surface.mesh.labels, box.labels);
  EXPECT_EQ(surface.length_unit, "mm");
  EXPECT_EQ(surface.stress_unit, "MPa");
  EXPECT_EQ(surface.displacement.at(5), Vec3(box.points[5].x(), 0, -1));
  EXPECT_EQ(surface.von_mises.at(7), box.points[7].z());
}

TEST(RenderData, ReadsTheFieldsOfOneLoadCase) {
  const TempFolder folder;
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 2);
  io::MeshFields fields;
  const std::size_t count = box.points.size();
  fields.points = {
      {"displacement_lift", "mm", 3, std::vector<double>(3 * count, 2.0)},
      {"von_mises_lift", "MPa", 1, std::vector<double>(count, 7.0)}};
  io::write_vtp(folder / "s.vtp", box, fields);
  const std::string path = (folder / "s.vtp").string();
  EXPECT_TRUE(render::load_surface(path).von_mises.empty());
  EXPECT_EQ(render::load_surface(path, "_lift").von_mises.at(3), 7.0);
}

TEST(RenderData, RefusesForeignFiles) {
  const TempFolder folder;
  EXPECT_THROW(render::load_surface((folder / "none.vtp").string()),
               InvalidInput);
  write_file(folder / "text.vtp", "no xml at all");
  EXPECT_THROW(render::load_surface((folder / "text.vtp").string()),
               InvalidInput);
  write_file(folder / "text.vtu", "");
  EXPECT_THROW(render::load_tets((folder / "text.vtu").string()), InvalidInput);
}

}  // namespace
}  // namespace meniscus::render_data_test
