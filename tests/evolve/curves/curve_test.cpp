#include "evolve/curves/curve.h"

#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::curve_test {
namespace {

using ::testing::HasSubstr;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kCurveRounding = 1e-13;  // some operations on numbers near 1

curves::Rectangle rounded() {
  curves::Rectangle r;
  r.width = 4.0;
  r.height = 2.0;
  r.corner_radius = 0.5;
  return r;
}

std::vector<curves::CurveShape> all_shapes() {
  curves::Ellipse ellipse;
  ellipse.radius_1 = 3.0;
  ellipse.radius_2 = 0.7;
  ellipse.normal = Vec3(1, 2, 2);
  curves::Rectangle sharp;
  sharp.width = 3.0;
  const curves::Polyline slot{
      {{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}},
      {std::nullopt, Vec3(3, 0, 0.2), std::nullopt, Vec3(-3, 0, 0)}};
  curves::CurveCopy copy{
      .of = std::make_shared<const curves::Curve>(curves::Curve{"slot", slot}),
      .offset = 0.3,
      .scale = Vec3(1, 2, 0.5),
      .mirror = Vec3(1, 1, 0),
      .angle = 0.7,
      .move = Vec3(1, 0, 0)};
  return {
      curves::Circle{Vec3(1, 2, 3), Vec3(0, -3, 1), 2.0},
      ellipse,
      rounded(),
      sharp,
      curves::Polygon{{{0, 0, 0}, {4, 0, 0}, {4, 1, 0.5}, {0, 2, 0}}},
      curves::Spline{
          {{2, 0, 0}, {0, 1, 0.3}, {-3, 0, 0}, {-2.5, -0.6, 0}, {0, -1, 0}}},
      slot,
      copy};
}

std::string refusal_of_shape(const curves::CurveShape& shape) {
  try {
    curves::validate({"rim", shape});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Curve, CircleHasItsRadiusPlaneAndDirection) {
  const curves::Circle c{Vec3(1, 2, 3), Vec3(2, -1, 4), 2.5};
  const Vec3 n = c.normal.normalized();
  for (int i = 0; i < 16; ++i) {
    const double t = i / 16.0;
    const Vec3 r = curves::point_at(c, t) - c.center;
    EXPECT_NEAR(r.norm(), 2.5, kCurveRounding * 10);
    EXPECT_NEAR(r.dot(n), 0.0, kCurveRounding * 10);
    const Vec3 next = curves::point_at(c, t + 1.0 / 16) - c.center;
    EXPECT_GT(r.cross(next).dot(n), 0.0);
  }
  EXPECT_LT((curves::point_at(curves::Circle{}, 0.0) - Vec3(1, 0, 0)).norm(),
            kCurveRounding);
  EXPECT_NEAR(curves::length_of(c), 5.0 * kHalfTurn, kCurveRounding * 100);
}

TEST(Curve, CircleFrameMovesLittleWhereTheNormalMovesLittle) {
  // The frame turns fast near its one bad normal only: within a bound of
  // 2 / distance elsewhere (stereographic projection).
  const Vec3 bad = -Vec3(2, 3, 6) / 7.0;
  std::mt19937 random(3);
  std::normal_distribution<double> at;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 n = Vec3(at(random), at(random), at(random)).normalized();
    const Vec3 d = kStep * n.unitOrthogonal();
    const double distance = (n - bad).norm();
    if (distance < 0.01) {
      continue;
    }
    const Vec3 p = curves::point_at(curves::Circle{Vec3::Zero(), n, 1.0}, 0.0);
    const Vec3 q =
        curves::point_at(curves::Circle{Vec3::Zero(), n + d, 1.0}, 0.0);
    EXPECT_LT((p - q).norm(), (2.0 + 4.0 / distance) * kStep);
  }
  for (const Vec3& n : {bad, Vec3(-bad), Vec3(1, 0, 0), Vec3(0, 0, -1)}) {
    EXPECT_TRUE(curves::point_at(curves::Circle{Vec3::Zero(), n, 1.0}, 0.3)
                    .allFinite());
  }
}

TEST(Curve, EveryShapeRunsRoundOnceWithItsOwnLength) {
  constexpr int kSteps = 20000;
  constexpr double kChord = 1e-6;  // relative error of the chords' sum
  for (const curves::CurveShape& shape : all_shapes()) {
    std::vector<double> t;
    for (int i = 0; i <= kSteps; ++i) {
      t.push_back(static_cast<double>(i) / kSteps);
    }
    const Points points = curves::points_at(shape, t);
    double length = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      length += (points[i + 1] - points[i]).norm();
    }
    EXPECT_NEAR(length / curves::length_of(shape), 1.0, kChord);
    EXPECT_LT(
        (curves::point_at(shape, 1.0) - curves::point_at(shape, 0.0)).norm(),
        kCurveRounding);
  }
}

TEST(Curve, EllipseLengthAgreesWithTheCircleAndRamanujan) {
  curves::Ellipse e;
  e.radius_1 = e.radius_2 = 2.0;
  EXPECT_NEAR(curves::length_of(e), 4.0 * kHalfTurn, 1e-12);
  e.radius_1 = 3.0;
  const double h = 1.0 / 25.0;  // ((a - b) / (a + b))^2
  const double ramanujan =
      kHalfTurn * 5.0 * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
  EXPECT_NEAR(curves::length_of(e), ramanujan,
              1e-8);  // the formula's own error
}

TEST(Curve, RectangleHasItsSidesAndCorners) {
  const curves::Rectangle r = rounded();
  Vec3 low = Vec3::Constant(9);
  Vec3 high = Vec3::Constant(-9);
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p = curves::point_at(r, i / 4000.0);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    const double x = std::max(std::abs(p.x()) - 1.5, 0.0);
    const double y = std::max(std::abs(p.y()) - 0.5, 0.0);
    EXPECT_NEAR(std::hypot(x, y), 0.5, 1e-12);
  }
  EXPECT_LT((high - Vec3(2, 1, 0)).norm() + (low + Vec3(2, 1, 0)).norm(),
            1e-12);
  EXPECT_NEAR(curves::length_of(r), 2 * 3 + 2 * 1 + kHalfTurn, 1e-12);
}

TEST(Curve, SamplesAreEvenEqualAndKeepCorners) {
  for (const curves::CurveShape& shape : all_shapes()) {
    for (const double edge : {10.0, 0.5, 0.11}) {
      const std::vector<double> t = curves::sample_parameters(shape, edge);
      EXPECT_EQ(t.size() % 2, 0U);
      EXPECT_GE(t.size(), 12U);
      EXPECT_EQ(t.front(), 0.0);
      for (std::size_t i = 0; i < t.size(); ++i) {
        EXPECT_LT(t[i], i + 1 < t.size() ? t[i + 1] : 1.0);
        const Vec3 chord =
            curves::point_at(shape, i + 1 < t.size() ? t[i + 1] : 1.0) -
            curves::point_at(shape, t[i]);
        EXPECT_LT(chord.norm(), 1.6 * edge);
      }
    }
  }
  const curves::CurveShape sharp = all_shapes()[3];
  const std::vector<double> t = curves::sample_parameters(sharp, 0.3);
  for (const double corner : {0.25, 0.5, 0.75}) {
    EXPECT_NE(std::find(t.begin(), t.end(), corner), t.end());
  }
  EXPECT_EQ(curves::sample_parameters(curves::Circle{}, 2.0 * kHalfTurn / 41.0)
                .size(),
            42U);
}

TEST(Curve, SamplesOfAnEllipseAreEqualInLength) {
  const curves::CurveShape shape = all_shapes()[1];
  const std::vector<double> t = curves::sample_parameters(shape, 0.01);
  const double piece = curves::length_of(shape) / static_cast<double>(t.size());
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double chord =
        (curves::point_at(shape, t[i + 1]) - curves::point_at(shape, t[i]))
            .norm();
    EXPECT_NEAR(chord / piece, 1.0, 1e-3);  // chord against arc at the tips
  }
}

TEST(Curve, PointsAreSmoothInTheNumbersAtFixedParameter) {
  // Second differences fall with the square of the step.
  const auto second = [](double t, double h) {
    const auto at = [&](double w) {
      curves::Rectangle r = rounded();
      r.width += w;
      r.corner_radius += 0.2 * w;
      r.normal = Vec3(w, 2 * w, 1);
      return curves::point_at(r, t);
    };
    return (at(h) + at(-h) - 2.0 * at(0.0)).norm();
  };
  for (const double t : {0.05, 0.2, 0.31, 0.47, 0.9}) {
    EXPECT_LT(second(t, 1e-3), 1e-4);
    EXPECT_NEAR(second(t, 2e-3) / second(t, 1e-3), 4.0, 0.1);
  }
}

TEST(Curve, RefusesWhatIsNoCurveAndSaysWhy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal_of_shape(curves::Circle{}), "");
  for (const double radius : {0.0, -1.0, nan, inf}) {
    EXPECT_THAT(
        refusal_of_shape(curves::Circle{Vec3::Zero(), Vec3::UnitZ(), radius}),
        HasSubstr("curve 'rim': radius is"));
  }
  EXPECT_THAT(refusal_of_shape(curves::Circle{Vec3::Zero(), Vec3::Zero(), 1.0}),
              HasSubstr("normal is zero"));
  EXPECT_THAT(
      refusal_of_shape(curves::Circle{Vec3(0, nan, 0), Vec3::UnitZ(), 1.0}),
      HasSubstr("center is (0, nan, 0)"));
  curves::Ellipse ellipse;
  ellipse.axis = Vec3(0, 0, -2);
  EXPECT_THAT(refusal_of_shape(ellipse), HasSubstr("parallel to normal"));
  curves::Rectangle r = rounded();
  r.corner_radius = 1.0;
  EXPECT_THAT(refusal_of_shape(r), HasSubstr("corner_radius is 1"));
  r.corner_radius = -0.1;
  EXPECT_THAT(refusal_of_shape(r), HasSubstr("corner_radius is -0.1"));
  EXPECT_THAT(refusal_of_shape(curves::Polygon{{{0, 0, 0}, {1, 0, 0}}}),
              HasSubstr("2 points, must have 3"));
  EXPECT_THAT(refusal_of_shape(curves::Polygon{
                  {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}}}),
              HasSubstr("points 3 and 0 are equal"));
  EXPECT_THROW(curves::sample_parameters(curves::Circle{}, 0.0), InvalidInput);
  EXPECT_THROW(curves::sample_parameters(curves::Circle{}, nan), InvalidInput);
}

/// One of each kind, its numbers at `p`.
curves::CurveCopy copy_at(double p, curves::CurveShape of,
                          std::optional<double> offset) {
  return {.of = std::make_shared<const curves::Curve>(
              curves::Curve{"first", std::move(of)}),
          .offset = offset,
          .scale = Vec3(1.0 + p, 2.0, 1.0 - p),
          .mirror = Vec3(1.0, p, 0.5),
          .angle = 0.3 + 2.0 * p,
          .axis = Vec3(p, 1.0, 1.0),
          .about = Vec3(0.1, -p, 0.0),
          .move = Vec3(0.0, 0.4, 3.0 * p)};
}

curves::CurveCopy copy_rate(curves::CurveShape of,
                            std::optional<double> offset) {
  return {.of = std::make_shared<const curves::Curve>(
              curves::Curve{"first", std::move(of)}),
          .offset = offset,
          .scale = Vec3(1.0, 0.0, -1.0),
          .mirror = Vec3(0.0, 1.0, 0.0),
          .angle = 2.0,
          .axis = Vec3(1.0, 0.0, 0.0),
          .about = Vec3(0.0, -1.0, 0.0),
          .move = Vec3(0.0, 0.0, 3.0)};
}

std::vector<curves::CurveShape> shapes_at(double p);
std::vector<curves::CurveShape> shape_rates();

/// Copies of all of them; but for the parametric one offset.
std::vector<curves::CurveShape> copies_at(double p) {
  std::vector<curves::CurveShape> result;
  for (const curves::CurveShape& shape : shapes_at(p)) {
    const bool plain = std::holds_alternative<curves::ParametricCurve>(shape);
    result.emplace_back(
        copy_at(p, shape, plain ? std::nullopt : std::optional(0.1 - 0.4 * p)));
  }
  return result;
}

std::vector<curves::CurveShape> copy_rates() {
  std::vector<curves::CurveShape> result;
  for (const curves::CurveShape& shape : shape_rates()) {
    const bool plain = std::holds_alternative<curves::ParametricCurve>(shape);
    result.emplace_back(
        copy_rate(shape, plain ? std::nullopt : std::optional(-0.4)));
  }
  return result;
}

std::vector<curves::CurveShape> shapes_at(double p) {
  const Vec3 center(0.3 + p, 0.2 - 2.0 * p, 0.5 * p);
  const Vec3 normal(0.2, 0.4 + p, 1.0 - 0.5 * p);
  const Vec3 axis(1.0, 0.3 * p, 0.2 + p);
  curves::Rectangle sharp{center, normal, axis, 2.0 + p, 1.0 - p, 0.0};
  curves::Rectangle round = sharp;
  round.corner_radius = 0.3 + 0.5 * p;
  return {
      curves::Circle{center, normal, 1.0 + 3.0 * p},
      curves::Ellipse{center, normal, axis, 1.0 + p, 0.5 - p},
      sharp,
      round,
      curves::Polygon{{center, axis, normal, Vec3(p, 2.0, -p)}},
      curves::ParametricCurve{
          {Expression(p), Expression(2.0 * p), Expression::parse("t", {"t"})}},
      curves::Spline{{center, Vec3(2.0, p, 0.0), Vec3(1.5, 2.0, p),
                      Vec3(-1.0, 1.5 - p, 0.2)}},
      curves::Polyline{{center, Vec3(2.0, p, 0.0), Vec3(1.5, 2.0, p)},
                       {std::nullopt, Vec3(2.5 + p, 1.0, 0.1), std::nullopt}}};
}

/// Their derivatives by p.
std::vector<curves::CurveShape> shape_rates() {
  const Vec3 center(1.0, -2.0, 0.5);
  const Vec3 normal(0.0, 1.0, -0.5);
  const Vec3 axis(0.0, 0.3, 1.0);
  return {
      curves::Circle{center, normal, 3.0},
      curves::Ellipse{center, normal, axis, 1.0, -1.0},
      curves::Rectangle{center, normal, axis, 1.0, -1.0, 0.0},
      curves::Rectangle{center, normal, axis, 1.0, -1.0, 0.5},
      curves::Polygon{{center, axis, normal, Vec3(1.0, 0.0, -1.0)}},
      curves::ParametricCurve{{Expression(1.0), Expression(2.0), Expression()}},
      curves::Spline{{center, Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitY()}},
      curves::Polyline{{center, Vec3::UnitY(), Vec3::UnitZ()},
                       {std::nullopt, Vec3::UnitX(), std::nullopt}}};
}

/// Central differences of points against the rates.
void expect_rates(
    const std::function<std::vector<curves::CurveShape>(double)>& at,
    const std::vector<curves::CurveShape>& rates) {
  constexpr double kStep = 1e-5;
  constexpr double kDifference = 1e-8;  // of central differences, relative
  constexpr double kAt = 0.1;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    for (const double t : {0.0, 0.07, 0.3, 0.56, 0.93}) {
      const Vec3 difference = (curves::point_at(at(kAt + kStep)[k], t) -
                               curves::point_at(at(kAt - kStep)[k], t)) /
                              (2.0 * kStep);
      const Vec3 rate = curves::point_rate(at(kAt)[k], rates[k], t);
      EXPECT_LT((rate - difference).norm(), kDifference * difference.norm())
          << "shape " << k << " at " << t;
    }
  }
}

TEST(CurveRate, IsTheDifferenceOfPoints) {
  expect_rates(shapes_at, shape_rates());
}

TEST(CurveRate, OfCopiesIsTheDifferenceOfPoints) {
  expect_rates(copies_at, copy_rates());
}

TEST(CurveRate, RefusesAnotherKind) {
  EXPECT_THROW(static_cast<void>(curves::point_rate(curves::Circle{},
                                                    curves::Ellipse{}, 0.0)),
               InvalidInput);
  const curves::Polygon three{Points(3, Vec3::Zero())};
  const curves::Polygon four{Points(4, Vec3::Zero())};
  EXPECT_THROW(static_cast<void>(curves::point_rate(three, four, 0.0)),
               InvalidInput);
}

TEST(AreEqual, LooksAtEveryNumber) {
  const std::vector<curves::CurveShape> shapes = all_shapes();
  for (std::size_t a = 0; a < shapes.size(); ++a) {
    const bool has_numbers =
        !std::holds_alternative<curves::ParametricCurve>(shapes[a]);
    for (std::size_t b = 0; b < shapes.size(); ++b) {
      const curves::CurveShape other = shapes[b];
      EXPECT_EQ(curves::are_equal(shapes[a], other), a == b && has_numbers)
          << a << " and " << b;
    }
  }
  curves::Polyline bent{{{-2, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-2, 1, 0}},
                        {std::nullopt, Vec3(3, 0, 0.2), std::nullopt, {}}};
  const curves::CurveShape before = bent;
  bent.via[1]->z() = 0.3;
  EXPECT_FALSE(curves::are_equal(before, bent));
  curves::CurveCopy copy{.of = std::make_shared<curves::Curve>(
                             curves::Curve{.name = "first", .shape = before})};
  const curves::CurveShape of_first = copy;
  copy.of = std::make_shared<curves::Curve>(
      curves::Curve{.name = "second", .shape = before});
  EXPECT_TRUE(curves::are_equal(of_first, copy));
  copy.of = std::make_shared<curves::Curve>(
      curves::Curve{.name = "first", .shape = bent});
  EXPECT_FALSE(curves::are_equal(of_first, copy));
}

}  // namespace
}  // namespace meniscus::curve_test
