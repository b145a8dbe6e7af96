#include "core/math/smooth_extreme.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace meniscus::smooth_extreme_test {
namespace {

constexpr double kRounding = 1e-12;
const std::vector<std::vector<double>> kSets = {
    {3.0, 1.0, 2.9}, {-3.0, -1.0, -2.0}, {0.5, 0.5}, {-2.0, 1e-3, 5.0, 4.9}};

double size_of(const std::vector<double>& x) {
  double squares = 0.0;
  for (const double value : x) {
    squares += value * value;
  }
  return std::sqrt(squares / static_cast<double>(x.size()));
}

TEST(SmoothExtreme, LiesOnTheSafeSideByNoMoreThanItsExcess) {
  for (const std::vector<double>& x : kSets) {
    for (const double excess : {0.2, 0.01, 1e-4}) {
      const double largest = *std::max_element(x.begin(), x.end());
      const double least = *std::min_element(x.begin(), x.end());
      const double above = smooth_maximum(x, excess).value;
      const double below = smooth_minimum(x, excess).value;
      const double reach = excess * size_of(x) * (1.0 + kRounding);
      EXPECT_GE(above, largest);
      EXPECT_LE(above, largest + reach);
      EXPECT_LE(below, least);
      EXPECT_GE(below, least - reach);
    }
  }
  // Equal numbers take all of it.
  EXPECT_NEAR(smooth_maximum(kSets[2], 0.1).value, 0.55, kRounding);
}

TEST(SmoothExtreme, DoesNotDependOnTheUnit) {
  for (std::vector<double> x : kSets) {
    const double here = smooth_maximum(x, 0.05).value;
    for (double& value : x) {
      value *= 1e-6;
    }
    EXPECT_NEAR(smooth_maximum(x, 0.05).value, 1e-6 * here,
                1e-6 * kRounding * std::abs(here));
  }
}

TEST(SmoothExtreme, DerivativesAreThoseOfDifferences) {
  constexpr double kStep = 1e-4;
  constexpr double kDifferences = 1e-8;  // fourth order in the step
  for (const std::vector<double>& x : kSets) {
    for (const bool least : {false, true}) {
      const auto value = [&](std::size_t i, double t) {
        std::vector<double> there = x;
        there[i] += t;
        return least ? smooth_minimum(there, 0.3) : smooth_maximum(there, 0.3);
      };
      const std::vector<double> exact = value(0, 0.0).by_number;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto slope = [&](double h) {
          return (value(i, h).value - value(i, -h).value) / (2.0 * h);
        };
        EXPECT_NEAR((4.0 * slope(kStep) - slope(2.0 * kStep)) / 3.0, exact[i],
                    kDifferences);
      }
    }
  }
}

TEST(SmoothExtreme, OneNumberIsItselfAndNoughtsHaveNoSlope) {
  EXPECT_EQ(smooth_maximum(std::vector<double>{-4.0}, 0.1).value, -4.0);
  EXPECT_EQ(smooth_maximum(std::vector<double>{-4.0}, 0.1).by_number[0], 1.0);
  const SmoothExtreme none = smooth_maximum(std::vector<double>{0.0, 0.0}, 0.1);
  EXPECT_EQ(none.value, 0.0);
  EXPECT_EQ(none.by_number, (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace meniscus::smooth_extreme_test
