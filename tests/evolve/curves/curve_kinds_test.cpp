// Splines, polylines with arcs and copies of curves.
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "evolve/curves/curve.h"

namespace meniscus::curve_kinds_test {
namespace {

using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-12;  // some operations on numbers near 1

std::string refusal(const curves::CurveShape& shape) {
  try {
    curves::validate({"rim", shape});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

curves::Spline circle_through(int count) {
  curves::Spline spline;
  for (int k = 0; k < count; ++k) {
    // Uneven on purpose: knots at chords take it.
    const double angle = 2.0 * kPi * (k + 0.2 * (k % 2)) / count;
    spline.points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  return spline;
}

double error_on_circle(int count) {
  std::vector<double> t;
  for (int i = 0; i < 1000; ++i) {
    t.push_back(i / 1000.0);
  }
  double worst = 0.0;
  for (const Vec3& p : curves::points_at(circle_through(count), t)) {
    worst = std::max(worst, std::abs(p.norm() - 1.0));
  }
  return worst;
}

TEST(Spline, ComesNearACircleWithTheFourthPowerOfItsPoints) {
  EXPECT_LT(error_on_circle(8), 0.01);
  EXPECT_LT(error_on_circle(32), 1e-4);
  // 2^4 = 16 per halving, as chord-length knots keep.
  EXPECT_NEAR(error_on_circle(32) / error_on_circle(64), 16.0, 4.0);
}

TEST(Spline, GoesThroughItsPointsWithContinuousCurvature) {
  const curves::Spline spline{
      {{2, 0, 0}, {0, 1, 0.3}, {-3, 0, 0}, {-2.5, -0.6, 0}, {0, -1, 0}}};
  double chords = 0.0;
  for (std::size_t k = 0; k < spline.points.size(); ++k) {
    chords += (spline.points[(k + 1) % 5] - spline.points[k]).norm();
  }
  double along = 0.0;
  for (std::size_t k = 0; k < spline.points.size(); ++k) {
    const double t = along / chords;
    EXPECT_LT((curves::point_at(spline, t) - spline.points[k]).norm(),
              kRounding);
    // Second differences on both sides of the knot.
    constexpr double kStep = 1e-4;
    const auto second = [&](double at) -> Vec3 {
      return (curves::point_at(spline, at + kStep) -
              2.0 * curves::point_at(spline, at) +
              curves::point_at(spline, at - kStep)) /
             (kStep * kStep);
    };
    const Vec3 jump = second(t + kStep) - second(t - kStep);
    EXPECT_LT(jump.norm(), 0.02 * (1.0 + second(t).norm()));
    along += (spline.points[(k + 1) % 5] - spline.points[k]).norm();
  }
}

TEST(Polyline, ArcsAreArcsOfCircles) {
  const curves::Polyline slot{
      {{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}},
      {std::nullopt, Vec3(3, 0, 0), std::nullopt, Vec3(-3, 0, 0)}};
  EXPECT_EQ(refusal(slot), "");
  EXPECT_NEAR(curves::length_of(slot), 8.0 + 2.0 * kPi, kRounding);
  for (int i = 0; i < 400; ++i) {
    const Vec3 p = curves::point_at(slot, i / 400.0);
    EXPECT_NEAR(std::hypot(std::max(std::abs(p.x()) - 2.0, 0.0), p.y()),
                std::abs(p.x()) > 2.0 ? 1.0 : std::abs(p.y()), kRounding);
  }
  // Three quarters of a circle: the long way, because the point says so.
  const curves::Polyline cap{{{1, 0, 0}, {0, 1, 0}},
                             {Vec3(-1, 0, 0), std::nullopt}};
  EXPECT_NEAR(curves::length_of(cap), 1.5 * kPi + std::sqrt(2.0), kRounding);
  EXPECT_LT((curves::point_at(cap, 0.25) + Vec3(1, 1, 0).normalized()).norm(),
            kRounding);
}

curves::CurveCopy copy_of(curves::CurveShape shape) {
  curves::CurveCopy copy;
  copy.of = std::make_shared<const curves::Curve>(
      curves::Curve{"first", std::move(shape)});
  return copy;
}

TEST(CurveCopy, MovesInTheOrderThatItSays) {
  curves::CurveCopy copy =
      copy_of(curves::Circle{Vec3(2, 0, 0), Vec3::UnitZ(), 1.0});
  copy.scale = Vec3(2, 1, 1);
  copy.mirror = Vec3::UnitY();
  copy.angle = 0.5 * kPi;
  copy.about = Vec3(1, 0, 0);
  copy.move = Vec3(0, 0, 5);
  // (3, 0, 0) -> (5, 0, 0) -> the same -> (1, 4, 0) -> (1, 4, 5)
  EXPECT_LT((curves::point_at(copy, 0.0) - Vec3(1, 4, 5)).norm(), kRounding);
  // (2, 1, 0) -> (3, 1, 0) -> (3, -1, 0) -> (2, 2, 0)
  EXPECT_LT((curves::point_at(copy, 0.25) - Vec3(2, 2, 5)).norm(), kRounding);
}

TEST(CurveCopy, OfACopyAddsUp) {
  curves::CurveCopy once = copy_of(curves::Circle{});
  once.move = Vec3(1, 2, 3);
  curves::CurveCopy twice = copy_of(once);
  twice.move = Vec3(1, 2, 3);
  for (const double t : {0.0, 0.3, 0.9}) {
    EXPECT_LT((curves::point_at(twice, t) -
               curves::point_at(curves::Circle{}, t) - Vec3(2, 4, 6))
                  .norm(),
              kRounding);
  }
}

TEST(CurveCopy, OffsetsAreAsFarAsTheySay) {
  curves::Ellipse ellipse;
  ellipse.radius_1 = 3.0;
  const curves::Polyline slot{
      {{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}},
      {std::nullopt, Vec3(3, 0, 0), std::nullopt, Vec3(-3, 0, 0)}};
  curves::Rectangle round;
  round.width = 4.0;
  round.height = 2.0;
  round.corner_radius = 0.8;
  // Splines are off by their points' fourth power.
  for (const auto& [shape, accuracy] :
       {std::pair(curves::CurveShape(curves::Circle{}), 1e-12),
        std::pair(curves::CurveShape(round), 1e-12),
        std::pair(curves::CurveShape(slot), 1e-12),
        std::pair(curves::CurveShape(ellipse), 1e-6),
        std::pair(curves::CurveShape(circle_through(32)), 1e-4)}) {
    for (const double offset : {-0.2, 0.3}) {
      curves::CurveCopy copy = copy_of(shape);
      copy.offset = offset;
      EXPECT_EQ(refusal(copy), "");
      std::vector<double> t(4000);
      for (std::size_t k = 0; k < t.size(); ++k) {
        t[k] = static_cast<double>(k) / static_cast<double>(t.size());
      }
      const Points first = curves::points_at(shape, t);
      for (const double at : {0.01, 0.13, 0.3, 0.62, 0.88}) {
        const Vec3 there = curves::point_at(copy, at);
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& p : first) {
          nearest = std::min(nearest, (p - there).norm());
        }
        // The nearest of the samples is off by half a step squared.
        EXPECT_NEAR(nearest, std::abs(offset), accuracy + 1e-5);
      }
      EXPECT_EQ(curves::length_of(copy) > curves::length_of(shape),
                offset > 0.0);
    }
  }
  curves::CurveCopy corner =
      copy_of(curves::Polygon{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}});
  corner.offset = 0.1;
  EXPECT_LT((curves::point_at(corner, 0.0) - Vec3(-0.1, -0.1, 0)).norm(),
            kRounding);
}

TEST(Curve, RefusesWhatIsNoneOfTheseKinds) {
  EXPECT_THAT(refusal(curves::Spline{{{0, 0, 0}, {1, 0, 0}}}),
              HasSubstr("spline has 2 points"));
  EXPECT_THAT(
      refusal(curves::Spline{{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}}),
      HasSubstr("points 1 and 2 are equal"));
  EXPECT_THAT(
      refusal(curves::Polyline{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}},
                               {Vec3(1, 0, 0), std::nullopt, std::nullopt}}),
      HasSubstr("on a line"));
  curves::CurveCopy copy = copy_of(curves::Circle{});
  copy.offset = -1.0;
  EXPECT_THAT(refusal(copy), HasSubstr("offset by -1: curve 'first': radius"));
  copy.offset.reset();
  copy.scale.x() = 0.0;
  EXPECT_THAT(refusal(copy), HasSubstr("scale is 0"));
  copy = copy_of(curves::Circle{});
  copy.axis.setZero();
  EXPECT_THAT(refusal(copy), HasSubstr("axis is zero"));
  copy = copy_of(copy_of(curves::Circle{}));
  copy.offset = 1.0;
  EXPECT_THAT(refusal(copy), HasSubstr("a copy has no offset"));
}

}  // namespace
}  // namespace meniscus::curve_kinds_test
