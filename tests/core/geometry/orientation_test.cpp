#include "core/geometry/orientation.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/nearly_flat.h"
#include "tests/support/rational_facets.h"

namespace meniscus::orientation_test {
namespace {

TEST(Orientation, IsThatOfRationalsForRandomPointsNearlyInAPlane) {
  std::mt19937 random(7);
  int flat = 0;
  int tilted = 0;
  for (int n = 0; n < 20000; ++n) {
    const Points x = rational::nearly_flat(random, 4);
    const int exact = rational::orientation(x[0], x[1], x[2], x[3]);
    ASSERT_EQ(orientation(x[0], x[1], x[2], x[3]), exact) << "sample " << n;
    (exact == 0 ? flat : tilted) += 1;
  }
  EXPECT_GT(flat, 2000);
  EXPECT_GT(tilted, 2000);
}

TEST(Orientation, TurnsWithTheOrderOfItsPoints) {
  std::mt19937 random(8);
  for (int n = 0; n < 2000; ++n) {
    const Points x = rational::nearly_flat(random, 4);
    const int sign = orientation(x[0], x[1], x[2], x[3]);
    EXPECT_EQ(orientation(x[1], x[0], x[2], x[3]), -sign);
    EXPECT_EQ(orientation(x[1], x[2], x[0], x[3]), sign);
    EXPECT_EQ(orientation(x[3], x[1], x[2], x[0]), -sign);
  }
}

// One unit in the last place off a plane, of numbers of any size: where doubles
// and extended precision underflow, overflow or cannot tell.
TEST(Orientation, SeesOneUnitInTheLastPlaceAtAnySize) {
  constexpr double kUp = std::numeric_limits<double>::infinity();
  for (const double size :
       {1e-307, 1e-200, 1e-110, 1e-30, 1.0, 1e30, 1e110, 1e200, 1e307}) {
    // Of the plane x + y + z = size.
    const Vec3 a(size, 0.0, 0.0);
    const Vec3 b(0.0, size, 0.0);
    const Vec3 c(0.0, 0.0, size);
    const Vec3 on(0.5 * size, 0.25 * size, 0.25 * size);
    const Vec3 above(on.x(), on.y(), std::nextafter(on.z(), kUp));
    const Vec3 below(on.x(), on.y(), std::nextafter(on.z(), -kUp));
    EXPECT_EQ(orientation(a, b, c, on), 0) << size;
    EXPECT_EQ(orientation(a, b, c, above), 1) << size;
    EXPECT_EQ(orientation(a, b, c, below), -1) << size;
  }
}

// 30 digits apart: too far for one number of extended precision.
TEST(Orientation, SeesSmallHeightsOverLargeFacets) {
  const Vec3 a(-1e15, 0.3, 0.0);
  const Vec3 b(1e15, 0.1, 0.0);
  const Vec3 c(0.7, 1e15, 0.0);
  EXPECT_EQ(orientation(a, b, c, {1.0, 1.0, 0.0}), 0);
  EXPECT_EQ(orientation(a, b, c, {1.0, 1.0, 1e-300}), 1);
  EXPECT_EQ(orientation(a, b, c, {1.0, 1.0, -1e-300}), -1);
}

TEST(Orientation, InAPlaneIsThatOfRationals) {
  std::mt19937 random(9);
  for (int n = 0; n < 6000; ++n) {
    const Points x = rational::nearly_flat(random, 3);
    const int along = n % 3;
    // A prism over the three points.
    Vec3 top = x[0];
    top[along] += 4.0 * (x[0].cwiseAbs().maxCoeff() + 1.0);
    const auto seen = [&](Vec3 p) {
      p[along] = x[0][along];
      return p;
    };
    ASSERT_EQ(orientation_along(along, x[0], x[1], x[2]),
              rational::orientation(x[0], seen(x[1]), seen(x[2]), top))
        << "sample " << n;
  }
}

}  // namespace
}  // namespace meniscus::orientation_test
