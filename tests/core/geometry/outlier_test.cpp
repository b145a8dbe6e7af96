#include "core/geometry/outlier.h"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meniscus::outlier_test {
namespace {

Points cloud(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  Points points;
  while (points.size() < count) {
    points.emplace_back(100.0 * place(random), place(random),
                        5.0 + place(random));
  }
  return points;
}

TEST(Outlier, AnyWildCoordinateIsFound) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Points points = cloud(seed, 8 + 10 * seed);
    EXPECT_FALSE(find_outlier(points)) << seed;
    const int at = static_cast<int>(seed * 7919 % points.size());
    const double wild =
        (seed % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, 6.0 + 5.0 * seed);
    points[static_cast<std::size_t>(at)][seed % 3] = wild;
    const auto found = find_outlier(points);
    ASSERT_TRUE(found) << seed;
    EXPECT_EQ(found->point, at);
    EXPECT_NEAR(found->distance, std::abs(wild), 1e-3 * std::abs(wild));
    EXPECT_THAT(outlier_text(*found, points),
                testing::HasSubstr("a number of it is wrong"));
  }
}

TEST(Outlier, PartsThatAreLongHaveNone) {
  Points spindle = cloud(1, 400);  // a fine disk, and a tip far above it
  for (Vec3& p : spindle) {
    p = Vec3(0.01 * p.x(), p.y(), 0.0);
  }
  spindle.emplace_back(0.0, 0.0, 500.0);
  EXPECT_FALSE(find_outlier(spindle));
  EXPECT_FALSE(find_outlier({}));
  EXPECT_FALSE(find_outlier(Points(20, Vec3(1, 2, 3))));
}

}  // namespace
}  // namespace meniscus::outlier_test
