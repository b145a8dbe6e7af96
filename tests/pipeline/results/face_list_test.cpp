#include "pipeline/results/face_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace meniscus::face_list_test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kPolygon = 0.01;  // of a circle by 48 sides

/// Radius 4 about (10, 2, 0), from z = 0 to 6; normals outwards, or inwards of
/// a bore.
SurfaceMesh round_wall(bool bore) {
  constexpr int kSides = 48;
  SurfaceMesh mesh;
  mesh.labels = {"wall"};
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2.0 * EIGEN_PI * k / kSides;
    const Vec3 p(10 + 4 * std::cos(angle), 2 + 4 * std::sin(angle), 0);
    mesh.points.push_back(p);
    mesh.points.push_back(p + Vec3(0, 0, 6));
  }
  for (int k = 0; k < kSides; ++k) {
    const int a = 2 * k;
    const int b = 2 * ((k + 1) % kSides);
    for (Triangle t : {Triangle{a, b, b + 1}, Triangle{a, b + 1, a + 1}}) {
      if (bore) {
        std::swap(t[0], t[1]);
      }
      mesh.facets.push_back(t);
      mesh.facet_label.push_back(0);
    }
  }
  return mesh;
}

TEST(FaceList, KnowsPlanes) {
  const SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 2);
  for (int label = 0; label < 6; ++label) {
    const results::FaceShape shape = results::face_shape(box, label);
    EXPECT_EQ(shape.kind, results::FaceKind::Plane);
    const bool low = box.labels[static_cast<std::size_t>(label)][1] == '0';
    EXPECT_NEAR(shape.direction.sum(), low ? -1.0 : 1.0, 1e-12);
  }
  EXPECT_NEAR(results::face_shape(box, box.label_of("z1")).area, 2.0, 1e-12);
}

TEST(FaceList, TellsABoreFromAPin) {
  for (const bool bore : {false, true}) {
    const results::FaceShape shape = results::face_shape(round_wall(bore), 0);
    EXPECT_EQ(shape.kind, results::FaceKind::Cylinder);
    EXPECT_EQ(shape.hollow, bore);
    EXPECT_NEAR(shape.radius, 4.0, 4.0 * kPolygon);
    EXPECT_NEAR((shape.place - Vec3(10, 2, 3)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(shape.direction.z(), 1.0, 1e-9);
  }
}

TEST(FaceList, KnowsSpheresAndOtherShapes) {
  SurfaceMesh ball = shapes::box(Vec3(2, 2, 2), 12);
  for (Vec3& p : ball.points) {
    p = Vec3(5, 0, 1) + 3.0 * (p - Vec3(1, 1, 1)).normalized();
  }
  std::fill(ball.facet_label.begin(), ball.facet_label.end(), 0);
  const results::FaceShape sphere = results::face_shape(ball, 0);
  EXPECT_EQ(sphere.kind, results::FaceKind::Sphere);
  EXPECT_NEAR(sphere.radius, 3.0, 1e-6);
  EXPECT_NEAR((sphere.place - Vec3(5, 0, 1)).norm(), 0.0, 1e-6);
  for (Vec3& p : ball.points) {
    p.x() *= 1.5;
  }
  EXPECT_EQ(results::face_shape(ball, 0).kind, results::FaceKind::Other);
}

TEST(FaceList, IsALineForEachFaceTheLargestFirst) {
  SurfaceMesh box = shapes::box(Vec3(1, 2, 3), 2);
  const std::string all = results::face_list(box, "mm");
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 5);
  EXPECT_LT(
      all.find("x1: plane at (1, 1, 1.5), outwards (1, 0, 0), area 6 mm2"),
      all.find("z0: plane at (0.5, 1, 0), outwards (0, 0, -1)"));
  EXPECT_THAT(results::face_list(box, "mm", 2), HasSubstr("and 4 more"));
  EXPECT_THAT(
      results::face_list(round_wall(true), "mm"),
      HasSubstr("wall: bore of radius 4 at (10, 2, 3) along (0, 0, 1)"));
  // A name without facets is told too, and nothing breaks.
  box.labels.emplace_back("nothing");
  EXPECT_THAT(results::face_list(box, "mm"), HasSubstr("nothing: curved"));
}

}  // namespace
}  // namespace meniscus::face_list_test
