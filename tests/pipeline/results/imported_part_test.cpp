#include "pipeline/results/imported_part.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "io/read_stl.h"
#include "io/stl.h"
#include "pipeline/files/part_file.h"
#include "pipeline/results/even_surface.h"
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
  ASSERT_TRUE(files::is_part_file(folder / "ball.STL"));
  const SurfaceMesh mesh = files::read_part_file(folder / "ball.STL", {});
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
  EXPECT_THROW(files::read_part_file(folder / "ball.igs", {}), InvalidInput);
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

/// A cylinder as CAD programs cut it: one needle along each of `n` sides, lids
/// of needles from one corner. Radius 3, height 20; labels side, low, high.
SurfaceMesh needles(int n) {
  SurfaceMesh mesh{.labels = {"side", "low", "high"}};
  for (const double z : {0.0, 20.0}) {
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * M_PI * k / n;
      mesh.points.emplace_back(3.0 * std::cos(angle), 3.0 * std::sin(angle), z);
    }
  }
  const auto add = [&](int a, int b, int c, int label) {
    mesh.facets.push_back({a, b, c});
    mesh.facet_label.push_back(label);
  };
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    add(k, next, n + next, 0);
    add(k, n + next, n + k, 0);
  }
  for (int k = 1; k + 1 < n; ++k) {
    add(0, k + 1, k, 1);
    add(n, n + k, n + k + 1, 2);
  }
  return mesh;
}

double smallest_angle(const SurfaceMesh& mesh) {
  double smallest = M_PI;
  for (const Triangle& t : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]];
      const Vec3 v = mesh.points[t[(k + 2) % 3]] - mesh.points[t[k]];
      smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  return smallest * 180.0 / M_PI;
}

TEST(ImportedPart, NeedlesBecomeEvenFacetsOnTheSameFaces) {
  constexpr double kTruth = 9.0 * M_PI * 20.0;  // the cylinder's volume
  ASSERT_LT(smallest_angle(needles(18)), 5.0);
  const results::PartShape shape(needles(360));
  for (const double edge : {1.0, 2.0, 4.0}) {
    const SurfaceMesh even = results::even_surface(needles(18), edge, shape);
    EXPECT_TRUE(check_surface(even).empty()) << edge;
    EXPECT_GT(smallest_angle(even), 20.0) << edge;
    EXPECT_EQ(even.labels, needles(18).labels);
    // A facet's sagitta over the radius, h^2 / 8 r^2 with h 0.27 r and less.
    EXPECT_NEAR(enclosed_volume(even) / kTruth, 1.0, 0.01) << edge;
    for (std::size_t f = 0; f < even.facets.size(); ++f) {
      for (const int v : even.facets[f]) {
        const Vec3& at = even.points[v];
        const double off = even.facet_label[f] == 0 ? at.head<2>().norm() - 3.0
                           : even.facet_label[f] == 1 ? at.z()
                                                      : at.z() - 20.0;
        EXPECT_NEAR(off, 0.0, 1e-3) << edge;  // a 360th of a turn is flat
      }
    }
    EXPECT_EQ(results::even_surface(needles(18), edge, shape).points,
              even.points);
  }
}

// All faces under one name, as those of a solid of `sides` are.
TEST(ImportedPart, SharpEdgesInsideAFaceStay) {
  SurfaceMesh plate =
      shapes::cubes({1, 1, 1}, 1, [](int, int, int) { return 0; });
  for (Vec3& p : plate.points) {
    p = p.cwiseProduct(Vec3(40.0, 20.0, 2.0));
  }
  const double volume = enclosed_volume(plate);
  ASSERT_NEAR(std::abs(volume), 1600.0, 1e-9);
  std::fill(plate.facet_label.begin(), plate.facet_label.end(), 0);
  plate.labels = {"all"};
  plate.facet_bodies.clear();
  const results::PartShape shape(plate);
  for (const double edge : {1.0, 3.0, 8.0}) {
    const SurfaceMesh even = results::even_surface(plate, edge, shape);
    EXPECT_NEAR(enclosed_volume(even) / volume, 1.0, 1e-9) << edge;
    EXPECT_NEAR(surface_area(even, 0) / surface_area(plate, 0), 1.0, 1e-9);
    EXPECT_TRUE(check_surface(even).empty()) << edge;
  }
}

}  // namespace
}  // namespace meniscus::imported_part_test
