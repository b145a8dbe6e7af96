#include "core/geometry/mesh_seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace meniscus::mesh_seams_test {
namespace {

constexpr double kRounding = 1e-12;

/// A brick whose cells belong to bodies by their centre; of body -1 there is
/// nothing. Faces are outer ones and those between bodies.
TetMesh bodies(const Vec3& size, int nx, int ny,
               const std::function<int(const Vec3&)>& body) {
  const TetMesh brick = shapes::brick(size, nx, ny, 1);
  TetMesh mesh;
  mesh.nodes = brick.nodes;
  mesh.corner_count = brick.corner_count;
  mesh.labels = {"all"};
  for (int e = 0; e < brick.element_count(); ++e) {
    const auto ids = brick.element(e);
    Vec3 centre = Vec3::Zero();
    for (const int id : ids) {
      centre += 0.25 * brick.nodes[static_cast<std::size_t>(id)];
    }
    if (const int region = body(centre); region >= 0) {
      mesh.elements.insert(mesh.elements.end(), ids.begin(), ids.end());
      mesh.element_region.push_back(region);
    }
  }
  std::map<std::array<int, 3>, std::vector<int>> beside;
  constexpr std::array<std::array<int, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const auto& face : kFaces) {
      std::array<int, 3> ids{};
      for (int k = 0; k < 3; ++k) {
        ids[k] = mesh.element(e)[face[k]];
      }
      std::sort(ids.begin(), ids.end());
      beside[ids].push_back(e);
    }
  }
  for (const auto& [ids, elements] : beside) {
    const bool outer = elements.size() == 1;
    if (outer ||
        mesh.element_region[elements[0]] != mesh.element_region[elements[1]]) {
      mesh.faces.insert(mesh.faces.end(), ids.begin(), ids.end());
      mesh.face_label.push_back(0);
      mesh.face_element.push_back(elements[0]);
      mesh.face_front.push_back(outer ? -1 : elements[1]);
    }
  }
  return mesh;
}

TEST(MeshSeams, OnePieceHasNone) {
  const TetMesh mesh =
      bodies({4.0, 1.0, 1.0}, 4, 1, [](const Vec3&) { return 0; });
  EXPECT_EQ(piece_count(mesh), 1);
  EXPECT_EQ(seam_length(mesh), 0.0);
}

TEST(MeshSeams, RowOfBlocksHasASeamAroundEachJoint) {
  const TetMesh mesh = bodies({4.0, 1.0, 1.0}, 4, 1, [](const Vec3& x) {
    return static_cast<int>(std::floor(x.x()));
  });
  EXPECT_EQ(piece_count(mesh), 4);
  EXPECT_NEAR(seam_length(mesh), 3.0 * 4.0, kRounding);
}

/// Two flanges, and a web of two plates end to end: three joints of 1 x 1.
TEST(MeshSeams, AnHOfFourPlatesCountsFour) {
  const TetMesh mesh = bodies({4.0, 3.0, 1.0}, 4, 3, [](const Vec3& x) {
    if (x.x() < 1.0 || x.x() > 3.0) {
      return x.x() < 1.0 ? 0 : 1;
    }
    const bool in_web = x.y() > 1.0 && x.y() < 2.0;
    return !in_web ? -1 : (x.x() < 2.0 ? 2 : 3);
  });
  EXPECT_EQ(piece_count(mesh), 4);
  EXPECT_NEAR(seam_length(mesh), 3.0 * 4.0, kRounding);
}

/// Bodies of one material that do not touch are pieces without a seam.
TEST(MeshSeams, ApartAreTwoPieces) {
  const TetMesh mesh = bodies({3.0, 1.0, 1.0}, 3, 1, [](const Vec3& x) {
    return x.x() > 1.0 && x.x() < 2.0 ? -1 : 0;
  });
  EXPECT_EQ(piece_count(mesh), 2);
  EXPECT_EQ(seam_length(mesh), 0.0);
}

/// A joint of quadratic edges is as long as its arc: of a bent row of blocks
/// the seam is still round a square.
TEST(MeshSeams, CurvedEdgesCountTheirArc) {
  TetMesh mesh = shapes::straight_quadratic(
      bodies({2.0, 1.0, 1.0}, 2, 1,
             [](const Vec3& x) { return x.x() < 1.0 ? 0 : 1; }));
  EXPECT_NEAR(seam_length(mesh), 4.0, kRounding);
  // x rises by y (1 - y) / 10 over each seam along y: a parabola's arc.
  for (Vec3& x : mesh.nodes) {
    x.x() += 0.1 * x.y() * (1.0 - x.y());
  }
  const double s = 0.1;
  const double arc = 0.5 * (std::sqrt(1.0 + s * s) + std::asinh(s) / s);
  constexpr double kGauss = 1e-8;  // three points, sixth order in the slope
  EXPECT_NEAR(seam_length(mesh), 2.0 + 2.0 * arc, kGauss);
}

}  // namespace
}  // namespace meniscus::mesh_seams_test
