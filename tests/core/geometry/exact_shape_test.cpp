/// Exact curves and surfaces: places and points undo each other, texts keep
/// every bit.
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/exact_points.h"

namespace meniscus {
namespace {

// Rounding of a few products and an arc tangent.
constexpr double kRounding = 1e-12;
// Feet on splines are found to the parameters' rounding, by steps.
constexpr double kFound = 1e-9;

ExactFrame tilted() {
  const Vec3 z = Vec3(1, 2, 3).normalized();
  const Vec3 x = z.cross(Vec3(0, 1, 0)).normalized();
  return {Vec3(0.3, -0.2, 5.0), x, z.cross(x), z};
}

/// A quarter of a cylinder of radius 2, rational and of degrees 2 and 1.
ExactSplineSurface quarter() {
  const double w = std::sqrt(0.5);
  return {2,
          1,
          {0, 0, 0, 1, 1, 1},
          {0, 0, 3, 3},
          {Vec3(2, 0, 0), Vec3(2, 0, 3), Vec3(2, 2, 0), Vec3(2, 2, 3),
           Vec3(0, 2, 0), Vec3(0, 2, 3)},
          {1, 1, w, w, 1, 1}};
}

std::vector<ExactSurface> surfaces() {
  return {ExactPlane{tilted()}, ExactCylinder{tilted(), 2.0},
          ExactCone{tilted(), 2.0, 0.4}, ExactSphere{tilted(), 2.0},
          ExactTorus{tilted(), 3.0, 1.0}};
}

TEST(ExactShape, PlacesUndoPoints) {
  for (const ExactSurface& surface : surfaces()) {
    for (const Vec2& place :
         {Vec2(0.3, 0.7), Vec2(2.9, -1.1), Vec2(6.0, 0.2)}) {
      const Vec2 found =
          place_on(surface, point_on(surface, place), place + Vec2(0.4, -0.3));
      EXPECT_LT((found - place).norm(), 10.0 * kRounding) << surface.index();
    }
  }
  const ExactSurface spline = quarter();
  for (const Vec2& place : {Vec2(0.1, 0.4), Vec2(0.93, 2.6), Vec2(0.5, 0.0)}) {
    const Vec3 at = point_on(spline, place);
    EXPECT_NEAR(std::hypot(at[0], at[1]), 2.0, kRounding);
    EXPECT_LT((place_on(spline, at, Vec2(0.5, 1.5)) - place).norm(), kFound);
    EXPECT_LT((place_on(spline, at) - place).norm(), kFound);
  }
}

TEST(ExactShape, FeetAreNearest) {
  const Vec3 off(0.02, -0.03, 0.01);
  std::vector<ExactSurface> all = surfaces();
  all.push_back(quarter());
  for (const ExactSurface& surface : all) {
    const Vec2 place(0.4, 0.6);
    const Vec3 at = point_on(surface, place) + off;
    const Vec2 foot = place_on(surface, at, place);
    const double least = (point_on(surface, foot) - at).norm();
    constexpr double kStep = 1e-3;
    for (const Vec2& step : {Vec2(kStep, 0.0), Vec2(-kStep, 0.0),
                             Vec2(0.0, kStep), Vec2(0.0, -kStep)}) {
      EXPECT_LT(least, (point_on(surface, foot + step) - at).norm())
          << surface.index();
    }
  }
}

TEST(ExactShape, PiecesOfAnEdgeAreEqual) {
  const ExactFrame f = tilted();
  const ExactEdge arc{"",  0,  1, ExactEllipse{f.origin, 2.0 * f.x, 2.0 * f.y},
                      1.0, 4.0};
  EXPECT_NEAR(length_of(arc), 6.0, 1e-3);  // by chords
  const std::vector<double> t = equal_pieces(arc, 6);
  ASSERT_EQ(t.size(), 7U);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(t[k], 1.0 + 0.5 * static_cast<double>(k), kRounding);
    EXPECT_NEAR(nearest_on(arc, point_on(arc.curve, t[k])), t[k], kFound);
  }
  EXPECT_EQ(nearest_on(arc, point_on(arc.curve, 0.8)), 1.0);
}

ExactShape sample() {
  ExactShape shape;
  shape.vertices = {Vec3(1.0 / 3.0, 0, 0), Vec3(1, 0.1, 0)};
  shape.edges = {
      {"rim", 0, 1, ExactLine{Vec3(1, 2, 3), Vec3::UnitY()}, 0, 2},
      {"", 1, 1,
       ExactSpline{1, {0, 0, 1, 1}, {Vec3(0, 0, 0), Vec3(1, 1, 1)}, {1, 0.1}},
       0, 1}};
  for (const ExactSurface& surface : surfaces()) {
    shape.faces.push_back({"pad", surface, false, {{{0, true, Vec2(0.1, 2)}}}});
  }
  shape.faces.push_back({"quarter", quarter(), true, {{{1, false}}}});
  return shape;
}

TEST(ExactShape, TextKeepsEveryBit) {
  const std::string text = exact_shape_text(sample());
  const ExactShape read = read_exact_shape_text(text);
  EXPECT_EQ(exact_shape_text(read), text);
  EXPECT_EQ(read.vertices[0][0], 1.0 / 3.0);
  EXPECT_EQ(read.faces[0].loops[0][0].start, Vec2(0.1, 2));
  for (std::size_t k = 0; k < read.faces.size(); ++k) {
    const Vec2 place(0.3, 0.4);
    EXPECT_EQ(point_on(read.faces[k].surface, place),
              point_on(sample().faces[k].surface, place));
  }
}

TEST(ExactShape, RefusesTextsThatAreNone) {
  EXPECT_THROW(read_exact_shape_text("{}"), InvalidInput);
  EXPECT_THROW(read_exact_shape_text("no"), InvalidInput);
  ExactShape shape = sample();
  shape.faces[0].loops[0][0].edge = 7;
  EXPECT_THROW(read_exact_shape_text(exact_shape_text(shape)), InvalidInput);
  shape = sample();
  std::get<ExactSpline>(shape.edges[1].curve).knots.pop_back();
  EXPECT_THROW(read_exact_shape_text(exact_shape_text(shape)), InvalidInput);
}

}  // namespace
}  // namespace meniscus
