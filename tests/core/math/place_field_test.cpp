// Fields of place against differences of themselves, at random places, numbers
// and coefficients.
#include "core/math/place_field.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus::place_field_test {
namespace {

using Random = std::mt19937;

double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}
Vec3 anywhere(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size),
          uniform(random, -size, size)};
}
VectorX random_numbers(Random& random, Eigen::Index count, double from,
                       double to) {
  VectorX v(count);
  for (double& x : v) {
    x = uniform(random, from, to);
  }
  return v;
}
Numbers span_of(const VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

/// Central difference of fourth order.
template <class Function>
auto slope_of(const Function& f, double step) -> decltype(f(0.0)) {
  return (8.0 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) /
         (12.0 * step);
}

struct Shapes {
  std::vector<std::shared_ptr<const PlaceShape>> all;
  Shapes() {
    all.push_back(box_splines(
        {.from = {-1, -0.5, 0}, .to = {1, 0.5, 2}, .counts = {4, 1, 3}}));
    all.push_back(box_splines(
        {.from = {-1, -0.5, 0}, .to = {1, 0.5, 2}, .counts = {2, 7, 5}}));
    all.push_back(axis_splines({.from = {0.3, -2.1, -1},
                                .to = {0.2, -2.0, 1},
                                .zero = {1, 1, 0},
                                .along = 4,
                                .around = 5}));
    all.push_back(axis_splines(
        {.from = {3, 0, -1}, .to = {3, 0.1, 1}, .along = 3, .around = 1}));
    Random random(3);
    RadialShape radial{.width = 0.6};
    for (int k = 0; k < 9; ++k) {
      radial.points.push_back(anywhere(random, 1.0));
    }
    all.push_back(radial_functions(radial));
  }
};

TEST(PlaceShape, IsAPartitionOfOneAndConvex) {
  Random random(11);
  for (const auto& shape : Shapes().all) {
    const int count = shape->coefficients();
    const VectorX ones = VectorX::Ones(count);
    for (int k = 0; k < 50; ++k) {
      const Vec3 at = anywhere(random, 1.9);
      const PlaceJet one = shape->jet(at, span_of(ones));
      EXPECT_NEAR(one.value, 1.0, 1e-14);
      EXPECT_NEAR(one.gradient.norm(), 0.0, 1e-12);
      EXPECT_NEAR(one.hessian.norm(), 0.0, 1e-11);
      VectorX c = VectorX::Zero(count);
      c[k % count] = 1.0;
      const double share = shape->jet(at, span_of(c)).value;
      EXPECT_GE(share, 0.0);
      EXPECT_LE(share, 1.0 + 1e-14);
    }
  }
}

TEST(PlaceShape, HasTheDerivativesOfItsValues) {
  Random random(12);
  for (const auto& shape : Shapes().all) {
    const VectorX c = random_numbers(random, shape->coefficients(), -1, 2);
    for (int k = 0; k < 40; ++k) {
      const Vec3 at = anywhere(random, 1.5);
      const Vec3 way = anywhere(random, 1.0).normalized();
      const PlaceJet jet = shape->jet(at, span_of(c));
      const auto there = [&](double s) {
        return shape->jet(at + s * way, span_of(c));
      };
      EXPECT_NEAR(slope_of([&](double s) { return there(s).value; }, 1e-3),
                  jet.gradient.dot(way), 2e-7);
      const Vec3 turn =
          slope_of([&](double s) { return Vec3(there(s).gradient); }, 1e-4);
      EXPECT_NEAR((turn - jet.hessian * way).norm(), 0.0, 2e-5);
      EXPECT_NEAR((jet.hessian - jet.hessian.transpose()).norm(), 0.0, 1e-12);
    }
  }
}

TEST(PlaceShape, TransposesItsValueAndGradient) {
  Random random(13);
  for (const auto& shape : Shapes().all) {
    const VectorX c = random_numbers(random, shape->coefficients(), -1, 2);
    for (int k = 0; k < 20; ++k) {
      const Vec3 at = anywhere(random, 1.5);
      const double by_value = uniform(random, -1, 1);
      const Vec3 by_gradient = anywhere(random, 1.0);
      VectorX sum = VectorX::Zero(c.size());
      shape->add_transposed(at, by_value, by_gradient,
                            {sum.data(), static_cast<std::size_t>(sum.size())});
      const PlaceJet jet = shape->jet(at, span_of(c));
      EXPECT_NEAR(sum.dot(c),
                  by_value * jet.value + by_gradient.dot(jet.gradient), 1e-12);
    }
  }
}

TEST(PlaceShape, OfABoxRunsFromTheFirstToTheLastCoefficient) {
  const auto shape =
      box_splines({.from = {0, 0, 0}, .to = {6, 0, 0}, .counts = {7, 1, 1}});
  VectorX line(7);
  line << 0, 1, 2, 3, 4, 5, 6;
  // Straight inside, flat beyond two and a half spacings.
  for (const double x : {1.6, 2.3, 3.0, 4.4}) {
    EXPECT_NEAR(shape->jet({x, 5, -7}, span_of(line)).value, x, 1e-14);
  }
  EXPECT_NEAR(shape->jet({-2.5, 0, 0}, span_of(line)).value, 0.0, 1e-15);
  EXPECT_NEAR(shape->jet({1e300, 0, 0}, span_of(line)).value, 6.0, 1e-14);
  EXPECT_NEAR(shape->jet({-1e300, 0, 0}, span_of(line)).value, 0.0, 1e-14);
}

TEST(PlaceShape, AroundAnAxisIsPeriodic) {
  const auto shape = axis_splines({.along = 1, .around = 8});
  VectorX c = VectorX::Zero(8);
  c[0] = 1.0;  // about the direction zero, x
  const auto at = [&](double angle) {
    return shape->jet({std::cos(angle), std::sin(angle), 0.4}, span_of(c))
        .value;
  };
  EXPECT_NEAR(at(0.0), 115.0 / 192.0, 1e-14);
  EXPECT_NEAR(at(0.3), at(-0.3), 1e-14);
  EXPECT_NEAR(at(std::numbers::pi), 0.0, 1e-14);
  EXPECT_NEAR(at(std::numbers::pi / 4), 19.0 / 96.0, 1e-14);
  EXPECT_THROW(shape->jet({0, 0, 0.2}, span_of(c)), ExpressionError);
}

TEST(PlaceShape, RefusesWhatIsNoShape) {
  EXPECT_THROW(box_splines({.counts = {0, 1, 1}}), InvalidInput);
  EXPECT_THROW(
      box_splines({.from = {1, 0, 0}, .to = {1, 1, 1}, .counts = {2, 1, 1}}),
      InvalidInput);
  EXPECT_THROW(axis_splines({.from = {1, 1, 1}, .to = {1, 1, 1}}),
               InvalidInput);
  EXPECT_THROW(axis_splines({.zero = {0, 0, 3}, .around = 2}), InvalidInput);
  EXPECT_THROW(axis_splines({.along = 0}), InvalidInput);
  EXPECT_THROW(radial_functions({.points = {}}), InvalidInput);
  EXPECT_THROW(radial_functions({.points = {Vec3::Zero()}, .width = 0.0}),
               InvalidInput);
}

PlaceField random_field(const std::string& text, Random& random) {
  PlaceField field =
      Expression::parse(text, {"x", "y", "z", "a", "b", "skin", "ring"});
  field.names = {"a", "b"};
  const Shapes shapes;
  field.shapes = {shapes.all[1], shapes.all[2]};
  field.numbers = random_numbers(
      random,
      2 + field.shapes[0]->coefficients() + field.shapes[1]->coefficients(),
      0.5, 1.5);
  return field;
}

const std::vector<std::string> kTexts = {
    "a + b * x * skin + sqr(ring)",
    "exp(-skin * z) * (1 + 0.3 * sin(a * x + ring)) / (1 + b * sqr(y))",
    "if(x > 0.2, a * skin, b + ring * y) + max(a, skin) + pow(1 + a, b)",
    "macaulay(x - a * y, 0, 0.5) + skin * macaulay(ring - b * z, 1, 0.2 + a)",
    "log(2 + skin) + atan2(ring, a) + abs(y - b) + tanh(skin * ring * x)"};

TEST(PlaceField, HasTheDerivativesOfItsValues) {
  Random random(21);
  for (const std::string& text : kTexts) {
    const PlaceField field = random_field(text, random);
    for (int k = 0; k < 25; ++k) {
      const Vec3 at = anywhere(random, 1.2);
      const Vec3 way = anywhere(random, 1.0).normalized();
      const PlaceJet jet = jet_at(field, span_of(field.numbers), at);
      EXPECT_DOUBLE_EQ(value_at(field, span_of(field.numbers), at), jet.value);
      const auto there = [&](double s) {
        return jet_at(field, span_of(field.numbers), at + s * way);
      };
      EXPECT_NEAR(slope_of([&](double s) { return there(s).value; }, 1e-4),
                  jet.gradient.dot(way), 1e-6)
          << text;
      const Vec3 turn =
          slope_of([&](double s) { return Vec3(there(s).gradient); }, 1e-4);
      EXPECT_NEAR((turn - jet.hessian * way).norm(), 0.0,
                  1e-4 * (1.0 + jet.hessian.norm()))
          << text;
    }
  }
}

TEST(PlaceField, KnowsTheDerivativesByItsNumbers) {
  Random random(22);
  for (const std::string& text : kTexts) {
    const PlaceField field = random_field(text, random);
    for (int k = 0; k < 25; ++k) {
      const Vec3 at = anywhere(random, 1.2);
      const double by_value = uniform(random, -1, 1);
      const Vec3 by_gradient = anywhere(random, 1.0);
      VectorX sum = VectorX::Zero(field.numbers.size());
      add_by_numbers(field, span_of(field.numbers), at, by_value, by_gradient,
                     sum);
      const VectorX rates = random_numbers(random, field.numbers.size(), -1, 1);
      const auto moved = [&](double s) {
        const VectorX numbers = field.numbers + s * rates;
        const PlaceJet jet = jet_at(field, span_of(numbers), at);
        return by_value * jet.value + by_gradient.dot(jet.gradient);
      };
      EXPECT_NEAR(sum.dot(rates), slope_of(moved, 1e-3), 2e-8) << text;
      // The other way: how fast value and gradient change.
      const PlaceJet rate =
          rate_at(field, span_of(field.numbers), span_of(rates), at);
      EXPECT_NEAR(by_value * rate.value + by_gradient.dot(rate.gradient),
                  sum.dot(rates), 1e-12 * (1.0 + std::abs(sum.dot(rates))))
          << text;
    }
  }
}

TEST(PlaceField, HasNoValueWhereItMustBePositive) {
  PlaceField field = Expression::parse("a - x", {"x", "y", "z", "a"});
  field.names = {"a"};
  field.numbers = VectorX::Constant(1, 2.0);
  field.positive = true;
  EXPECT_DOUBLE_EQ(value_at(field, span_of(field.numbers), {1, 0, 0}), 1.0);
  EXPECT_THROW(value_at(field, span_of(field.numbers), {2, 0, 0}),
               ExpressionError);
  EXPECT_THROW(jet_at(field, span_of(field.numbers), {3, 0, 0}),
               ExpressionError);
}

TEST(PlaceField, StandsAsAnExpressionAtItsNumbers) {
  PlaceField field = Expression::parse("a * x + 1e1 * ab",  //
                                       {"x", "y", "z", "a", "ab"});
  field.names = {"a", "ab"};
  field.numbers = VectorX(2);
  field.numbers << -0.1, 1.0 / 3.0;
  const Expression alone = with_numbers(field);
  const Vec3 at(0.7, 0.1, 0.2);
  EXPECT_EQ(value_at(alone, at), value_at(field, span_of(field.numbers), at));
  Random random(1);
  EXPECT_THROW(with_numbers(random_field(kTexts[0], random)), InvalidInput);
}

TEST(PlaceField, FormulasTransposeTheirSecondDerivatives) {
  Random random(5);
  const std::vector<std::string> names = {"x", "y", "z", "w"};
  const Expression f = Expression::parse(
      "x^2*y + sin(z*w)/(1 + sqr(x)) + if(w > 0, w*y, exp(z)) + y", names);
  for (int k = 0; k < 30; ++k) {
    const VectorX v = random_numbers(random, 4, -1, 1);
    const VectorX r = random_numbers(random, 4, -1, 1);
    const double by_value = uniform(random, -1, 1);
    const double by_rate = uniform(random, -1, 1);
    VectorX by_values = VectorX::Zero(4);
    VectorX by_rates = VectorX::Zero(4);
    const Expression::Rate found =
        f.transpose(span_of(v), span_of(r), by_value, by_rate,
                    {by_values.data(), 4}, {by_rates.data(), 4});
    std::vector<Dual> duals;
    duals.reserve(4);
    for (int i = 0; i < 4; ++i) {
      duals.push_back(Dual::variable(v[i], i, 4));
    }
    const Dual exact = f.evaluate(duals);
    EXPECT_DOUBLE_EQ(found.value, exact.value);
    EXPECT_NEAR(found.rate, exact.gradient.dot(r), 1e-14);
    EXPECT_NEAR(
        (by_values - by_value * exact.gradient - by_rate * exact.hessian * r)
            .norm(),
        0.0, 1e-13);
    EXPECT_NEAR((by_rates - by_rate * exact.gradient).norm(), 0.0, 1e-13);
  }
}

}  // namespace
}  // namespace meniscus::place_field_test
