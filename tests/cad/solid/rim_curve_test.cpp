#include "cad/solid/rim_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "cad/solid/curve_through.h"
#include "cad/solid/rim_edges.h"

namespace meniscus::rim_curve_test {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// Two straight sides and two half circles.
solid::RimCurve stadium() {
  return solid::RimCurve(
      {{solid::StraightLine{Vec3(-2, -1, 0), Vec3::UnitX()}, 0.0, 4.0},
       {solid::EllipseCurve{Vec3(2, 0, 0), Vec3::UnitX(), Vec3::UnitY()},
        -0.25 * kWholeTurn, 0.25 * kWholeTurn},
       {solid::StraightLine{Vec3(2, 1, 0), -Vec3::UnitX()}, 0.0, 4.0},
       {solid::EllipseCurve{Vec3(-2, 0, 0), -Vec3::UnitX(), -Vec3::UnitY()},
        -0.25 * kWholeTurn, 0.25 * kWholeTurn}});
}

TEST(RimCurve, KnowsLengthAndPlaces) {
  const solid::RimCurve curve = stadium();
  EXPECT_NEAR(curve.length(), 8.0 + kWholeTurn, 1e-12);
  for (int k = 0; k < 40; ++k) {
    const double s = curve.length() * k / 40.0;
    EXPECT_NEAR(curve.nearest(curve.point(s)), s, 1e-9);
    EXPECT_NEAR((curve.point(s + 1e-6) - curve.point(s - 1e-6)).norm(), 2e-6,
                1e-10);
  }
  for (int k = 0; k < 4; ++k) {
    EXPECT_FALSE(curve.is_sharp(k));
  }
  EXPECT_NEAR(curve.turning(1), 0.5 * kWholeTurn, 1e-9);
}

TEST(RimCurve, SplineThroughPointsClosesSmoothly) {
  Points points;
  for (int k = 0; k < 48; ++k) {
    const double angle = kWholeTurn * k / 48.0;
    points.emplace_back(std::cos(angle), std::sin(angle),
                        0.2 * std::cos(2.0 * angle));
  }
  const solid::RimCurve curve = solid::rim_through(points);
  ASSERT_EQ(curve.piece_count(), 1);
  EXPECT_FALSE(curve.is_sharp(0));
  constexpr double kTolerance = 1e-5;  // the poles' third differences, a little
  for (const Vec3& p : points) {
    EXPECT_NEAR((curve.point(curve.nearest(p)) - p).norm(), 0.0, kTolerance);
  }
  // The end is also the beginning: places just before it are near it.
  const Vec3 before = curve.point(curve.length() - 1e-3);
  EXPECT_NEAR(curve.nearest(before), curve.length() - 1e-3, kTolerance);
  const solid::RimPiece& piece = curve.piece(0);
  EXPECT_NEAR((solid::point_of(piece.curve, piece.first) -
               solid::point_of(piece.curve, piece.last))
                  .norm(),
              0.0, kTolerance);
}

/// A waist much narrower than the samples from which places are looked for.
TEST(RimCurve, PlacesBesideAWaistAreOnTheirOwnSide) {
  Points points;
  for (int k = 0; k < 160; ++k) {
    const double angle = kWholeTurn * k / 160.0;
    const double half = 0.02 + 0.98 * std::pow(std::cos(angle), 2);
    points.emplace_back(4.0 * std::cos(angle) + 0.1 * std::sin(angle),
                        half * std::sin(angle), 0.0);
  }
  const solid::RimCurve curve = solid::rim_through(points);
  for (int k = 0; k < 1000; ++k) {
    const double s = curve.length() * (k + 0.31) / 1000.0;
    EXPECT_NEAR(curve.nearest(curve.point(s)), s, 1e-6) << k;
  }
}

TEST(RimCurve, CornersStayCorners) {
  Points points;
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 5; ++k) {
      const double s = k / 5.0;
      points.push_back(side == 0   ? Vec3(s, 0, 0)
                       : side == 1 ? Vec3(1, s, 0)
                       : side == 2 ? Vec3(1 - s, 1, 0)
                                   : Vec3(0, 1 - s, 0));
    }
  }
  const solid::RimCurve curve = solid::rim_through(points);
  ASSERT_EQ(curve.piece_count(), 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_TRUE(curve.is_sharp(k));
  }
  constexpr double kTolerance = 1e-3;  // lengths of splines are by 64 samples
  EXPECT_NEAR(curve.length(), 4.0, kTolerance);
}

TEST(RimEdges, WishesNearEachOtherBecomeOneVertex) {
  const solid::RimCurve curve = stadium();
  solid::RimEdges edges(curve);
  edges.want(1.0);
  edges.want(1.05);
  edges.want(4.02);  // the end of the first side
  solid::Brep brep;
  edges.build(0.1, brep);
  EXPECT_EQ(brep.vertices.size(), 5U);
  EXPECT_EQ(brep.edges.size(), 5U);
  EXPECT_EQ(edges.vertex(1.05), edges.vertex(1.0));
  const auto steps = edges.between(1.0, 4.0, false);
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_FALSE(steps[0].forward);
  EXPECT_NEAR(edges.way(1.0, 4.0, false), curve.length() - 3.0, 1e-12);
  for (const solid::BrepEdge& edge : brep.edges) {
    EXPECT_LT(
        (solid::point_of(edge.curve, edge.first) - brep.vertices[edge.from])
            .norm(),
        1e-12);
    EXPECT_LT((solid::point_of(edge.curve, edge.last) - brep.vertices[edge.to])
                  .norm(),
              1e-12);
  }
}

/// A square of side 2 with one side from (0, -1, 0) to (0, 1, 0) or back.
solid::RimCurve square(const Vec3& away, bool up) {
  const Vec3 low(0, -1, 0);
  const Vec3 high(0, 1, 0);
  Points corners{low, high, high + 2.0 * away, low + 2.0 * away};
  if (!up) {
    std::reverse(corners.begin(), corners.end());
  }
  std::vector<solid::RimPiece> pieces;
  for (int k = 0; k < 4; ++k) {
    const Vec3 way = corners[(k + 1) % 4] - corners[k];
    pieces.push_back(
        {solid::StraightLine{corners[k], way.normalized()}, 0.0, way.norm()});
  }
  return solid::RimCurve(std::move(pieces));
}

TEST(RimEdges, RimsThatShareASideHaveItsEdgesInCommon) {
  const solid::RimCurve first = square(Vec3::UnitX(), true);
  const solid::RimCurve second = square(Vec3::UnitZ(), false);
  solid::RimEdges owner(first);
  solid::RimEdges other(second);
  other.share(2, owner, 0, true);  // from (0, 1, 0) to (0, -1, 0)
  other.want(4.5);                 // at (0, 0.5, 0)
  other.want(4.02);                // near the side's own end
  solid::Brep brep;
  owner.build(0.1, brep, 1e-9);
  other.build(0.1, brep, 1e-9);
  EXPECT_EQ(brep.vertices.size(), 7U);  // six corners and the wish
  EXPECT_EQ(brep.edges.size(), 8U);
  EXPECT_EQ(other.vertex(4.5), owner.vertex(1.5));
  const auto there = other.between(4.0, 6.0, true);
  const auto back = owner.between(0.0, 2.0, true);
  ASSERT_EQ(there.size(), 2U);
  ASSERT_EQ(back.size(), 2U);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(there[k].edge, back[1 - k].edge);
    EXPECT_NE(there[k].forward, back[1 - k].forward);
    EXPECT_NEAR(there[k].first, 1.0 - back[1 - k].first, 1e-12);
  }
}

// Parts of curves and their pieces run backwards are the curves' own points.
TEST(RimCurve, PartsAreTheSameCurve) {
  const solid::RimCurve curve = stadium();
  const double from = 0.8 * curve.length();
  const double to = 1.3 * curve.length();  // across the beginning
  std::vector<double> ends;
  const std::vector<solid::RimPiece> parts = curve.between(from, to, ends);
  ASSERT_EQ(parts.size(), ends.size());
  EXPECT_DOUBLE_EQ(ends.back(), to);
  double start = from;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const solid::RimPiece back = solid::reversed(parts[k]);
    for (const double share : {0.0, 0.3, 1.0}) {
      const auto at = [&](const solid::RimPiece& piece, double t) {
        return solid::point_of(piece.curve,
                               piece.first + t * (piece.last - piece.first));
      };
      const Vec3 exact = curve.point(start + share * (ends[k] - start));
      EXPECT_LT((at(parts[k], share) - exact).norm(), 1e-9);
      EXPECT_LT((at(back, 1.0 - share) - exact).norm(), 1e-9);
    }
    start = ends[k];
  }
}

TEST(CurveThrough, OpenPointsKnowTheirPlaces) {
  Points points;
  for (int k = 0; k <= 4; ++k) {  // a straight side, then an arc off a corner
    points.emplace_back(k, 0, 0);
  }
  for (int k = 1; k <= 6; ++k) {
    const double a = 0.25 * kWholeTurn * k / 6.0;
    points.emplace_back(4.0 - 2.0 * std::sin(a), 2.0 - 2.0 * std::cos(a), 0);
  }
  const solid::PointCurve curve = solid::curve_through(points, false);
  ASSERT_EQ(curve.pieces.size(), 2U);
  EXPECT_TRUE(
      std::holds_alternative<solid::StraightLine>(curve.pieces[0].curve));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [piece, share] = curve.at[k];
    const solid::RimPiece& on = curve.pieces[piece];
    EXPECT_LT(
        (solid::point_of(on.curve, on.first + share * (on.last - on.first)) -
         points[k])
            .norm(),
        1e-4);
  }
}

}  // namespace
}  // namespace meniscus::rim_curve_test
