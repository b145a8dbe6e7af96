#include "core/geometry/plane_points.h"

#include <cmath>

#include <gtest/gtest.h>

namespace meniscus::plane_points_test {
namespace {

TEST(PlanePoints, CrossProductIsTheAreaWithItsSign) {
  EXPECT_EQ(cross2({2, 0}, {1, 3}), 6.0);
  EXPECT_EQ(cross2({1, 3}, {2, 0}), -6.0);
}

TEST(PlanePoints, SegmentsCrossWhereTheySay) {
  const Vec2 a(1, 1);
  const Vec2 b(5, 3);
  const auto share = segment_crossing(a, b, {2, 9}, {2, -1});
  ASSERT_TRUE(share);
  EXPECT_NEAR(*share, 0.25, 1e-15);
  EXPECT_FALSE(segment_crossing(a, b, {2, 9}, {2, 2}));
  EXPECT_FALSE(segment_crossing(a, b, {3, 2}, {3, 9}));  // an end on it
  EXPECT_FALSE(segment_crossing(a, b, {3, 2}, {9, 5}));  // on one line
  EXPECT_EQ(segment_sides(a, b, {3, 2}, {3, 9})[0], 0.0);
}

// Products of rounding have signs of their own.
TEST(PlanePoints, SegmentsOnOneLineNeverCross) {
  for (int k = 1; k < 200; ++k) {
    const Vec2 from(5.0, 5.0);
    const Vec2 way(-std::cos(0.1 * k), -std::sin(0.1 * k));
    const auto at = [&](double t) { return Vec2(from + t * way); };
    EXPECT_FALSE(segment_crossing(at(0.1), at(0.35), at(0.6), at(0.85))) << k;
    EXPECT_FALSE(segment_crossing(at(0.1), at(0.7), at(0.3), at(0.9))) << k;
  }
}

TEST(PlanePoints, DistanceIsToTheEndsToo) {
  EXPECT_NEAR(distance_to_segment({2, 2}, {0, 0}, {4, 0}), 2.0, 1e-15);
  EXPECT_NEAR(distance_to_segment({7, 4}, {0, 0}, {4, 0}), 5.0, 1e-15);
  EXPECT_NEAR(distance_to_segment({3, 4}, {0, 0}, {0, 0}), 5.0, 1e-15);
}

TEST(PlanePoints, BoxIsAroundAll) {
  EXPECT_TRUE(box_of({}).isEmpty());
  const Eigen::AlignedBox2d box = box_of({{1, 5}, {3, -2}, {2, 0}});
  EXPECT_EQ(box.min(), Vec2(1, -2));
  EXPECT_EQ(box.max(), Vec2(3, 5));
}

}  // namespace
}  // namespace meniscus::plane_points_test
