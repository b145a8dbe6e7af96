#include "cad/solid/patch_knots.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace meniscus::patch_knots_test {
namespace {

solid::RimPiece line(const Vec3& from, const Vec3& to) {
  return {solid::StraightLine{from, (to - from).normalized()}, 0.0,
          (to - from).norm()};
}

/// A triangle whose first side ends at `middle`; the side goes on to `end`.
solid::RimCurve triangle(const Vec3& middle, const Vec3& end) {
  return solid::RimCurve({line(Vec3::Zero(), middle), line(middle, end),
                          line(end, Vec3(1, 5, 0)),
                          line(Vec3(1, 5, 0), Vec3::Zero())});
}

/// Demand of the first two pieces, from one corner of the triangle to the next.
solid::SideDemand first_two(const solid::RimCurve& curve,
                            solid::RimEdges& edges, solid::Brep& brep) {
  edges.build(1e-9, brep);
  const double end = curve.start_of(2);
  return {.length = end, .rim = {&edges, 0.0, end}};
}

int multiplicity_near(const std::vector<double>& knots, double at) {
  return static_cast<int>(
      std::count_if(knots.begin(), knots.end(),
                    [&](double k) { return std::abs(k - at) < 1e-6; }));
}

// One rim is straight on at the middle and another has a corner there, a
// rounding further along: the knot is the corner's.
TEST(PatchKnots, BreaksWithinRoundingKeepTheSharpersKnots) {
  const solid::RimCurve smooth = triangle(Vec3(1, 0, 0), Vec3(2, 0, 0));
  ASSERT_FALSE(smooth.is_sharp(1));
  for (const double shift : {-1e-8, 0.0, 1e-8}) {
    const solid::RimCurve bent =
        triangle(Vec3(1 + shift, 0, 0), Vec3(1 + shift, 1 - shift, 0));
    ASSERT_TRUE(bent.is_sharp(1));
    solid::Brep brep;
    solid::RimEdges smooth_edges(smooth);
    solid::RimEdges bent_edges(bent);
    const std::vector<double> knots =
        solid::common_knots({first_two(smooth, smooth_edges, brep),
                             first_two(bent, bent_edges, brep)},
                            10.0);
    EXPECT_EQ(multiplicity_near(knots, 0.5), 3) << shift;
  }
}

}  // namespace
}  // namespace meniscus::patch_knots_test
