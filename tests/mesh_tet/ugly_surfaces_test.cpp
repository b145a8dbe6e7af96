// Whatever comes in, a mesh or a typed failure comes out, soon.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/timer.h"
#include "mesh_tet/tetrahedralize.h"
#include "tests/support/shapes.h"

namespace meniscus::ugly_surfaces_test {

namespace {

constexpr double kTimeForUgly = 5.0;  // of one surface [s]
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Nothing but a mesh with the surface's volume, or a typed failure with a
/// message. Returns whether there is a mesh.
bool survives(const SurfaceMesh& surface, const std::string& name,
              std::optional<double> edge = {}) {
  SCOPED_TRACE(name);
  const Timer timer;
  const auto result = mesh_tet::tetrahedralize(
      surface, {.edge = edge, .time_limit = kTimeForUgly});
  EXPECT_LT(timer.seconds(), kTimeForUgly + 1.0);
  if (result.failure) {
    EXPECT_TRUE(result.failure->kind == FailureKind::SurfaceInvalid ||
                result.failure->kind == FailureKind::MeshingFailed);
    EXPECT_FALSE(result.failure->message.empty());
    EXPECT_TRUE(result.mesh.nodes.empty());
    return false;
  }
  double volume = 0.0;
  for (int e = 0; e < result.mesh.element_count(); ++e) {
    volume += corner_volume(result.mesh, e);
  }
  const double expected = enclosed_volume(surface);
  EXPECT_NEAR(volume, expected, 1e-9 * expected);
  return true;
}

void add_facet(SurfaceMesh& mesh, const Triangle& facet) {
  mesh.facets.push_back(facet);
  mesh.facet_label.push_back(0);
}

SurfaceMesh both(SurfaceMesh mesh, const SurfaceMesh& other, const Vec3& shift,
                 double scale = 1.0) {
  const int first = static_cast<int>(mesh.points.size());
  for (const Vec3& p : other.points) {
    mesh.points.push_back(scale * p + shift);
  }
  for (const Triangle& t : other.facets) {
    add_facet(mesh, {first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

TEST(UglySurfaces, NothingAndTooLittle) {
  EXPECT_FALSE(survives({}, "empty"));
  SurfaceMesh points = shapes::sphere(1.0, 0);
  points.facets.clear();
  points.facet_label.clear();
  EXPECT_FALSE(survives(points, "points only"));
  SurfaceMesh one = points;
  add_facet(one, {0, 1, 2});
  EXPECT_FALSE(survives(one, "one facet"));
  SurfaceMesh back = one;
  add_facet(back, {0, 2, 1});
  EXPECT_FALSE(survives(back, "two sides of one facet"));
  SurfaceMesh unlabelled = shapes::sphere(1.0, 1);
  unlabelled.facet_label.clear();
  EXPECT_FALSE(survives(unlabelled, "no labels"));
}

TEST(UglySurfaces, NotNumbersAndWrongIds) {
  const SurfaceMesh ball = shapes::sphere(1.0, 1);
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL, 1e308, 1e200, 1e30}) {
    SurfaceMesh mesh = ball;
    mesh.points[5].y() = bad;
    EXPECT_FALSE(survives(mesh, "coordinate " + std::to_string(bad)));
  }
  for (const int bad : {-1, 42, 1 << 30, std::numeric_limits<int>::min()}) {
    SurfaceMesh mesh = ball;
    mesh.facets[7][1] = bad;
    EXPECT_FALSE(survives(mesh, "corner " + std::to_string(bad)));
  }
  SurfaceMesh same = ball;
  same.facets[3][1] = same.facets[3][0];
  EXPECT_FALSE(survives(same, "facet with one corner twice"));
  SurfaceMesh loose = ball;
  loose.points.emplace_back(5, 5, 5);
  EXPECT_FALSE(survives(loose, "unused point outside"));
  loose.points.back().setZero();
  EXPECT_FALSE(survives(loose, "unused point inside"));
}

TEST(UglySurfaces, TinyAndHuge) {
  for (const double size : {1e-30, 1e-9, 1e-3, 1e9, 1e30}) {
    SurfaceMesh mesh = shapes::sphere(1.0, 2);
    for (Vec3& p : mesh.points) {
      p *= size;
    }
    EXPECT_TRUE(survives(mesh, "size " + std::to_string(size)));
  }
  for (const double size : {1e-200, 1e150}) {
    SurfaceMesh mesh = shapes::sphere(1.0, 1);
    for (Vec3& p : mesh.points) {
      p *= size;
    }
    EXPECT_FALSE(survives(mesh, "size " + std::to_string(size)));
  }
  for (const double far : {1e3, 1e6, 1e12, 1e18}) {
    SurfaceMesh mesh = shapes::sphere(1.0, 2);
    for (Vec3& p : mesh.points) {
      p += Vec3(far, -far, far);
    }
    survives(mesh, "far away " + std::to_string(far));
  }
}

TEST(UglySurfaces, OpenDuplicatedTurned) {
  const SurfaceMesh ball = shapes::sphere(1.0, 2);
  SurfaceMesh open = ball;
  open.facets.pop_back();
  open.facet_label.pop_back();
  EXPECT_FALSE(survives(open, "open"));
  SurfaceMesh twice = ball;
  add_facet(twice, ball.facets[10]);
  EXPECT_FALSE(survives(twice, "duplicate facet"));
  SurfaceMesh turned = ball;
  std::swap(turned.facets[4][0], turned.facets[4][1]);
  EXPECT_FALSE(survives(turned, "one facet turned"));
  SurfaceMesh inward = ball;
  for (Triangle& t : inward.facets) {
    std::swap(t[0], t[1]);
  }
  EXPECT_FALSE(survives(inward, "inside out"));
  EXPECT_FALSE(survives(both(ball, ball, Vec3::Zero()), "the same twice"));
  EXPECT_FALSE(survives(both(ball, ball, Vec3::Zero(), 0.5), "solid in solid"));
  EXPECT_FALSE(survives(both(ball, inward, Vec3(3, 0, 0)), "cavity outside"));
  EXPECT_FALSE(
      survives(both(ball, inward, Vec3(0.9, 0, 0), 0.5), "crossing cavity"));
  EXPECT_TRUE(survives(both(ball, inward, Vec3::Zero(), 0.5), "cavity"));
}

TEST(UglySurfaces, CrossingAndTouching) {
  const SurfaceMesh ball = shapes::sphere(1.0, 2);
  for (const double shift : {0.1, 0.7, 1.5, 1.99}) {
    EXPECT_FALSE(survives(both(ball, ball, Vec3(shift, 0.01, 0.003)),
                          "crossing " + std::to_string(shift)));
  }
  const SurfaceMesh box = shapes::box(Vec3::Ones(), 2);
  for (const double gap : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5}) {
    survives(both(box, box, Vec3(1.0 + gap, 0.1, 0.2)),
             "gap " + std::to_string(gap), 0.3);
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    SurfaceMesh mesh = shapes::sphere(1.0, 1);
    const double noise = 0.05 * (i + 1);
    for (Vec3& p : mesh.points) {
      p += noise * Vec3(uniform(random), uniform(random), uniform(random));
    }
    survives(mesh, "random " + std::to_string(i));
  }
}

TEST(UglySurfaces, FlatAndThin) {
  for (const double height :
       {0.0, 1e-300, 1e-12, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
    SurfaceMesh mesh = shapes::sphere(1.0, 2);
    for (Vec3& p : mesh.points) {
      p.z() *= height;
    }
    survives(mesh, "flat ball " + std::to_string(height), 0.1);
    survives(shapes::box(Vec3(1, 1, height), 4),
             "flat box " + std::to_string(height), 0.1);
  }
  for (const double width : {1e-9, 1e-6, 1e-4, 1e-2}) {
    SurfaceMesh mesh = shapes::box(Vec3::Ones(), 4);
    for (Vec3& p : mesh.points) {
      p.x() = p.x() == 0.25 ? width : p.x();
    }
    survives(mesh, "slivers " + std::to_string(width), 0.3);
  }
  SurfaceMesh spike = shapes::sphere(1.0, 2);
  spike.points[0] *= 100.0;
  survives(spike, "spike", 1.0);
  spike.points[0] *= -1e-2;
  survives(spike, "spike through", 1.0);
}

}  // namespace

}  // namespace meniscus::ugly_surfaces_test
