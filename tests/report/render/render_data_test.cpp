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
  const SurfaceMesh half = render::cut_open(tets, Vec3(0, -1, 0));
  EXPECT_NEAR(enclosed_volume(half), 4.0, kDataRounding);
  EXPECT_NEAR(surface_area(half, 1), 2.0, kDataRounding);
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
