#include "pipeline/results/imported_part.h"

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "io/read_stl.h"
#include "io/stl.h"
#include "pipeline/forward/part_file.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace meniscus::imported_part_test {
namespace {

constexpr double kRounding = 1e-12;  // of sums of a few hundred numbers

/// A tetrahedron with legs 1, 2, 3 and a named face each.
std::string tetrahedron() {
  const std::array<const char*, 4> x = {"0 0 0", "1 0 0", "0 2 0", "0 0 3.0"};
  const std::array<Triangle, 4> faces = {
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  std::string text;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::string name = "solid face " + std::to_string(f) + "\n";
    text += name + " facet normal nan nan nan\n  outer loop\n";
    for (const int k : faces[f]) {
      text += "   vertex " + std::string(x[static_cast<std::size_t>(k)]) + "\n";
    }
    text += "  endloop\n endfacet\nend" + name;
  }
  return text;
}

TEST(ReadStl, SolidsAreNamedFaces) {
  const SurfaceMesh mesh = io::read_stl_text(tetrahedron(), "t.stl");
  EXPECT_EQ(mesh.points.size(), 4U);
  EXPECT_EQ(mesh.facets.size(), 4U);
  EXPECT_EQ(mesh.labels[2], "face 2");
  EXPECT_EQ(mesh.facet_label, std::vector<int>({0, 1, 2, 3}));
  EXPECT_NEAR(enclosed_volume(mesh), 1.0, kRounding);
  EXPECT_TRUE(check_surface(mesh).empty());
}

TEST(ReadStl, WrongFilesAreToldByLine) {
  const std::string good = tetrahedron();
  EXPECT_THROW(io::read_stl_text("", "t.stl"), InvalidInput);
  EXPECT_THROW(io::read_stl_text(std::string("so\0lid", 6), "t.stl"),
               InvalidInput);
  for (std::size_t cut = 1; cut < 90; cut += 7) {
    EXPECT_THROW(
        io::read_stl_text(good.substr(0, good.size() - 16 - cut), "t.stl"),
        InvalidInput);
  }
  try {
    io::read_stl_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 x 0\n",
                      "t.stl");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("t.stl:4: found 'x'"),
              std::string::npos)
        << error.what();
  }
}

TEST(ReadStl, BinaryFilesAreOneFace) {
  const SurfaceMesh ball = shapes::sphere(2.0, 2);
  const TempFolder folder;
  io::write_stl(folder / "ball.STL", ball, {.name = "solid ball"});
  ASSERT_TRUE(forward::is_part_file(folder / "ball.STL"));
  const SurfaceMesh mesh = forward::read_part_file(folder / "ball.STL", {});
  EXPECT_EQ(mesh.facets.size(), ball.facets.size());
  EXPECT_EQ(mesh.points.size(), ball.points.size());
  EXPECT_EQ(mesh.labels.size(), 1U);
  constexpr double kFloats = 1e-6;  // 32-bit coordinates
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(ball), 1.0, kFloats);
  EXPECT_TRUE(check_surface(mesh).empty());

  std::string bytes = read_file(folder / "ball.STL");
  EXPECT_THROW(io::read_stl_text(bytes.substr(0, bytes.size() - 1), "b.stl"),
               InvalidInput);
  const float broken = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 50 * 7 + 12, &broken, sizeof broken);
  EXPECT_THROW(io::read_stl_text(bytes, "b.stl"), InvalidInput);
  EXPECT_THROW(forward::read_part_file(folder / "ball.igs", {}), InvalidInput);
}

TEST(ImportedPart, ShortEdgesKeepTheShape) {
  const SurfaceMesh coarse = io::read_stl_text(tetrahedron(), "t.stl");
  for (const double longest : {5.0, 2.5, 1.1, 0.4}) {
    const SurfaceMesh fine = results::with_short_edges(coarse, longest);
    EXPECT_NEAR(enclosed_volume(fine), 1.0, kRounding);
    for (int label = 0; label < 4; ++label) {
      EXPECT_NEAR(surface_area(fine, label), surface_area(coarse, label),
                  kRounding);
    }
    EXPECT_TRUE(check_surface(fine).empty()) << longest;
    std::vector<Edge> edges;
    std::vector<Triangle> facet_edges;
    list_edges(fine.facets, edges, facet_edges);
    for (const Edge& e : edges) {
      EXPECT_LE((fine.points[static_cast<std::size_t>(e[0])] -
                 fine.points[static_cast<std::size_t>(e[1])])
                    .norm(),
                longest);
    }
  }
}

}  // namespace
}  // namespace meniscus::imported_part_test
