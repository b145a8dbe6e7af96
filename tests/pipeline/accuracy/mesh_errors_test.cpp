#include "pipeline/accuracy/mesh_errors.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace meniscus::mesh_errors_test {
namespace {

using namespace accuracy;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// limit + slope h^order on the three meshes.
MeshValues values_of(double limit, double slope, double order) {
  MeshValues values{};
  for (std::size_t m = 0; m < values.size(); ++m) {
    values[m] = limit + slope * std::pow(kEdgeFactors[m], order);
  }
  return values;
}

// Of figures that fall by any order from the least that is assumed.
TEST(MeshErrors, CoverEveryOrderFromAHalf) {
  std::mt19937 random(20261123);
  std::uniform_real_distribution<double> orders(0.5, 4.0);
  std::uniform_real_distribution<double> numbers(-1.0, 1.0);
  for (int k = 0; k < 2000; ++k) {
    const double slope = numbers(random);
    const double order = orders(random);
    const MeshValues values = values_of(10.0 * numbers(random), slope, order);
    for (const FigureKind kind : {FigureKind::Integral, FigureKind::Extreme}) {
      const FigureError error = figure_error(values, kind);
      EXPECT_GE(error.bound, std::abs(slope)) << "order " << order;
      EXPECT_TRUE(error.settles) << "order " << order;
    }
    if (order >= 1.0 && order <= 2.0) {
      const double bound = figure_error(values, FigureKind::Film).bound;
      EXPECT_GE(bound, std::abs(slope)) << "order " << order;
      EXPECT_LT(bound, 1.6 * std::abs(slope)) << "order " << order;
    }
    // No wilder than needed where the order is that of the films and elements.
    if (order <= 1.0) {
      EXPECT_LT(figure_error(values, FigureKind::Integral).bound,
                1.6 * std::abs(slope));
    }
  }
}

// A peak where geometry knows of no edge without a limit: half as wide as any
// extreme's, and falling values have a limit however they change.
TEST(MeshErrors, OfPeaksThatHaveALimit) {
  for (const double order : {1.0, 1.4, 2.0, 3.0}) {
    for (const double slope : {-1.0, 1.0}) {
      const MeshValues values = values_of(10.0, slope, order);
      const FigureError error = figure_error(values, FigureKind::Peak);
      EXPECT_GE(error.bound, 1.0) << "order " << order;
      EXPECT_LT(error.bound,
                0.5 * figure_error(values, FigureKind::Extreme).bound);
      EXPECT_TRUE(error.settles);
    }
  }
  const MeshValues falls = {115.4, 127.0, 134.9};
  EXPECT_TRUE(figure_error(falls, FigureKind::Peak).settles);
  EXPECT_FALSE(figure_error(falls, FigureKind::Extreme).settles);
  // One that grows as much may be at an edge that geometry does not know.
  const MeshValues grows = {134.9, 123.3, 115.4};
  const FigureError error = figure_error(grows, FigureKind::Peak);
  EXPECT_FALSE(error.settles);
  EXPECT_EQ(error.bound, figure_error(grows, FigureKind::Extreme).bound);
}

// The third mesh changes what the two others say: errors by a change alone
// could not tell these apart.
TEST(MeshErrors, FollowTheOrderOfThreeMeshes) {
  const double slow = figure_error({1.0, 2.0, 3.3}, FigureKind::Integral).bound;
  const double fast = figure_error({1.0, 1.4, 3.3}, FigureKind::Integral).bound;
  EXPECT_GT(slow, 1.2 * fast);
}

TEST(MeshErrors, FiguresWithoutLimitDoNotSettle) {
  for (const double order : {-0.5, -0.29, 0.2}) {
    EXPECT_FALSE(
        figure_error(values_of(0.0, 1.0, order), FigureKind::Extreme).settles);
  }
  // A logarithm's changes are all alike.
  EXPECT_FALSE(figure_error({3.0, 2.0, 1.0}, FigureKind::Extreme).settles);
}

// Smooth peaks change so on coarse meshes, and have a limit.
TEST(MeshErrors, SmallChangesAreNoTrend) {
  const auto settles = [](double change) {
    return figure_error({1000.0, 1000.0 - change, 1000.0 - 1.9 * change},
                        FigureKind::Extreme)
        .settles;
  };
  EXPECT_TRUE(settles(0.4));
  EXPECT_TRUE(settles(40.0));
  EXPECT_FALSE(settles(80.0));
}

TEST(MeshErrors, ScatterIsNoOrder) {
  const FigureError error = figure_error({1.0, 1.1, 1.0}, FigureKind::Integral);
  EXPECT_GT(error.bound, 0.1);
  EXPECT_TRUE(error.settles);
  // Meshes that cut the part alike tell nothing.
  EXPECT_TRUE(
      std::isnan(figure_error({2.0, 2.0, 2.0}, FigureKind::Extreme).bound));
}

// Where no coarser film is there a finer one judges: it covers the error of the
// mesh itself, which is more than the change to the finer one.
TEST(MeshErrors, AFinerMeshJudgesAlone) {
  for (const double order : {1.0, 1.5, 2.0}) {
    const MeshValues all = values_of(5.0, 1.0, order);
    const double bound =
        figure_error({all[0], kNaN, kNaN, all[kFinerMesh]}, FigureKind::Film)
            .bound;
    EXPECT_GE(bound, 1.0) << "order " << order;
    EXPECT_LT(bound, 3.0) << "order " << order;
    EXPECT_GT(bound, std::abs(all[0] - all[kFinerMesh]));
    // It is not asked where a coarser one answers.
    EXPECT_EQ(
        figure_error({all[0], all[1], kNaN, 7.0}, FigureKind::Film).bound,
        figure_error({all[0], all[1], kNaN, kNaN}, FigureKind::Film).bound);
  }
  EXPECT_TRUE(std::isnan(
      figure_error({1.0, kNaN, kNaN, kNaN}, FigureKind::Film).bound));
}

TEST(MeshErrors, TwoMeshesSayLessThanThree) {
  const MeshValues all = values_of(5.0, 1.0, 1.0);
  const double three = figure_error(all, FigureKind::Integral).bound;
  const double without_coarse =
      figure_error({all[0], all[1], kNaN, kNaN}, FigureKind::Integral).bound;
  const double without_middle =
      figure_error({all[0], kNaN, all[2], kNaN}, FigureKind::Integral).bound;
  EXPECT_GT(without_coarse, three);
  EXPECT_GT(without_middle, three);
  EXPECT_TRUE(std::isnan(
      figure_error({all[0], kNaN, kNaN, kNaN}, FigureKind::Integral).bound));
}

// Figures of order 2, and margins that fall as a root of what is left.
TEST(FinerFilmError, IsTheErrorTimesItsSafety) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> numbers(-1.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    const double limit = 2.0 + numbers(random);
    const double slope = numbers(random);
    const auto smooth = [&](double h) { return limit + slope * h * h; };
    EXPECT_NEAR(finer_film_error(smooth(1.0), smooth(0.5), FilmLaw::Smooth),
                1.5 * std::abs(slope), 1e-12);
    const auto root = [&](double h) {
      return std::sqrt(limit + slope * h * h);
    };
    EXPECT_NEAR(finer_film_error(root(1.0), root(0.5), FilmLaw::Root),
                1.5 * std::abs(root(1.0) - root(0.0)), 1e-12);
  }
}

// Next to its end another such step leaves no film: the whole margin, and half
// as much again.
TEST(FinerFilmError, OfAMarginThatEndsIsMoreThanTheMargin) {
  EXPECT_DOUBLE_EQ(finer_film_error(1.0, 0.4, FilmLaw::Root), 1.5);
  EXPECT_DOUBLE_EQ(finer_film_error(1.0, 0.4, FilmLaw::Smooth), 1.2);
  for (const FilmLaw law : {FilmLaw::Smooth, FilmLaw::Root}) {
    EXPECT_TRUE(std::isnan(finer_film_error(1.0, kNaN, law)));
  }
}

// Where the square of every margin changes by the same, the one to hold is just
// kept with its error.
TEST(MarginToHold, LessItsErrorIsTheBound) {
  std::mt19937 random(20261127);
  std::uniform_real_distribution<double> numbers(0.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    const double lower = numbers(random);
    const double own = 0.1 + numbers(random);
    const double change = 0.7 * own * own * numbers(random);
    const auto error_of = [&](double margin) {
      return finer_film_error(
          margin, std::sqrt(margin * margin - 0.75 * change), FilmLaw::Root);
    };
    const double held = margin_to_hold(lower, own, error_of(own));
    EXPECT_NEAR(held - error_of(held), lower, 1e-12);
  }
  // Of one that ends on finer facets no more is known than its square.
  EXPECT_DOUBLE_EQ(margin_to_hold(0.5, 1.0, 7.0),
                   margin_to_hold(0.5, 1.0, 1.5));
}

}  // namespace
}  // namespace meniscus::mesh_errors_test
