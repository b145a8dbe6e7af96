#include "core/geometry/facet_pairs.h"

#include <random>

#include <gtest/gtest.h>

#include "core/geometry/orientation.h"
#include "tests/support/nearly_flat.h"
#include "tests/support/rational_facets.h"

namespace meniscus::facet_pairs_test {
namespace {

/// Two facets without a common corner.
SurfaceMesh pair_of(const Points& six) {
  SurfaceMesh mesh;
  mesh.points = six;
  mesh.facets = {{0, 1, 2}, {3, 4, 5}};
  mesh.facet_label = {0, 0};
  mesh.labels = {"pair"};
  return mesh;
}

bool is_a_line(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int along = 0; along < 3; ++along) {
    if (orientation_along(along, a, b, c) != 0) {
      return false;
    }
  }
  return true;
}

// Nothing is taken for crossing that does not, nothing missed that does, be it
// by one unit in the last place.
TEST(FacetPairs, MeetExactlyWhereRationalsSaySo) {
  std::mt19937 random(11);
  int meeting = 0;
  int apart = 0;
  for (int n = 0; n < 6000; ++n) {
    const Points x = rational::nearly_flat(random, 6);
    if (is_a_line(x[0], x[1], x[2]) || is_a_line(x[3], x[4], x[5])) {
      continue;
    }
    const bool exact = rational::meet({x[0], x[1], x[2]}, {x[3], x[4], x[5]});
    const bool found =
        classify_pair(pair_of(x), 0, 1, 0.0).state == PairState::Crossing;
    ASSERT_EQ(found, exact) << "sample " << n;
    (exact ? meeting : apart) += 1;
  }
  EXPECT_GT(meeting, 1000);
  EXPECT_GT(apart, 500);
}

// A corner just above, on and just below the other facet.
TEST(FacetPairs, TellOneUnitInTheLastPlace) {
  constexpr double kUp = std::numeric_limits<double>::infinity();
  // x + y + z = 1 holds exactly for (0.5, 0.25, 0.25).
  const Vec3 on(0.5, 0.25, 0.25);
  for (const int side : {-1, 0, 1}) {
    Vec3 tip = on;
    tip.z() = side == 0 ? tip.z() : std::nextafter(tip.z(), side * kUp);
    const Points x = {{1, 0, 0}, {0, 1, 0},    {0, 0, 1},
                      tip,       {2, 2, 2.25}, {2, 1.5, 3}};
    EXPECT_EQ(classify_pair(pair_of(x), 0, 1, 0.0).state,
              side > 0 ? PairState::Apart : PairState::Crossing)
        << side;
  }
}

}  // namespace
}  // namespace meniscus::facet_pairs_test
