#include "evolve/walls/thicken.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/shapes.h"
#include "tests/support/sheet_shapes.h"

namespace meniscus::thicken_test {
namespace {

constexpr double kPi = std::numbers::pi;
// What a wall promises where it is within the safe thickness.
constexpr double kPromised = 0.05;
// Rounding of sums over some hundred facets of size 1.
constexpr double kRounding = 1e-12;
// Observed orders of a second-order method on irregular sheets.
constexpr double kSecondOrder = 1.7;

walls::ThickWall wall_of(const SurfaceMesh& film, double thickness,
                         walls::WallSide side = walls::WallSide::Both) {
  return walls::thicken(film,
                        {.thickness = Expression(thickness), .side = side});
}

void expect_promised(const walls::ThickWall& wall, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_TRUE(wall.findings.empty()) << summary(wall.findings);
  EXPECT_GT(wall.thinnest.value, (1.0 - kPromised) * wall.thinnest.asked);
  EXPECT_LT(wall.thickest.value, (1.0 + kPromised) * wall.thickest.asked);
  EXPECT_EQ(wall.trace.size(), wall.surface.points.size());
  EXPECT_EQ(wall.surface.facet_label.size(), wall.surface.facets.size());
  EXPECT_GT(wall.volume, 0.0);
}

SurfaceMesh catenoid(int n) {
  return shapes::catenoid_sheet(0.6,
                                {.rows = n / 4, .columns = n, .around = true});
}

SurfaceMesh plane(double height = 0.0) {
  return shapes::patch(
      [height](double u, double v) -> Vec3 {
        return {u, v, height};
      },
      {});
}

SurfaceMesh joined(const SurfaceMesh& a, const SurfaceMesh& b) {
  SurfaceMesh both = a;
  const auto first = static_cast<int>(a.points.size());
  const auto label = static_cast<int>(a.labels.size());
  both.points.insert(both.points.end(), b.points.begin(), b.points.end());
  both.labels.insert(both.labels.end(), b.labels.begin(), b.labels.end());
  for (std::size_t f = 0; f < b.facets.size(); ++f) {
    const auto& [i, j, k] = b.facets[f];
    both.facets.push_back({i + first, j + first, k + first});
    both.facet_label.push_back(b.facet_label[f] + label);
  }
  return both;
}

TEST(Thicken, PlaneIsExact) {
  for (const walls::WallSide side :
       {walls::WallSide::Both, walls::WallSide::Inside,
        walls::WallSide::Outside}) {
    const walls::ThickWall wall = wall_of(plane(), 0.125, side);
    expect_promised(wall, "plane");
    EXPECT_NEAR(wall.volume, 0.125, kRounding);
    EXPECT_NEAR(wall.thinnest.value, 0.125, kRounding);
    EXPECT_NEAR(wall.thickest.value, 0.125, kRounding);
    EXPECT_EQ(wall.safe.limit, walls::WallLimit::None);
  }
}

TEST(Thicken, CatenoidKeepsItsThicknessUpToTheCurvature) {
  for (const int n : {24, 48}) {
    const SurfaceMesh film = catenoid(n);
    for (const double t : {0.1, 0.5, 1.0, 1.5}) {
      for (const double side : {1.0, -1.0}) {
        SurfaceMesh turned = film;
        for (Triangle& f : turned.facets) {
          f = side > 0.0 ? f : Triangle{f[0], f[2], f[1]};
        }
        const walls::ThickWall wall = wall_of(turned, t);
        expect_promised(wall, std::to_string(t));
        EXPECT_GT(wall.safe.value, t);
      }
    }
  }
}

TEST(Thicken, SafeThicknessIsThatOfTheWaist) {
  // 1.8 / k with k = 1 at the waist, at second order.
  std::array<double, 3> error{};
  for (int i = 0; i < 3; ++i) {
    const walls::ThickWall wall = wall_of(catenoid(24 << i), 0.1);
    EXPECT_EQ(wall.safe.limit, walls::WallLimit::Curvature)
        << wall.safe.message;
    EXPECT_LT(std::abs(wall.safe.place.z()), 0.06);
    error[i] = std::abs(wall.safe.value - 1.8);
  }
  EXPECT_GT(std::log2(error[1] / error[2]), kSecondOrder);
  EXPECT_LT(error[2], 0.01);
  // One-sided walls go the whole way towards the centre.
  const walls::ThickWall inside =
      wall_of(catenoid(48), 0.1, walls::WallSide::Inside);
  EXPECT_NEAR(inside.safe.value, 0.9, 0.02);
  expect_promised(wall_of(catenoid(48), 0.85, walls::WallSide::Inside),
                  "inside");
  expect_promised(wall_of(catenoid(48), 0.85, walls::WallSide::Outside),
                  "outside");
}

TEST(Thicken, ClosedSphereBecomesAShellWithAVoid) {
  const SurfaceMesh film = shapes::sphere(1.0, 3);
  const walls::ThickWall wall = wall_of(film, 0.5);
  expect_promised(wall, "sphere");
  EXPECT_EQ(wall.surface.points.size(), 2 * film.points.size());
  EXPECT_EQ(wall.surface.facets.size(), 2 * film.facets.size());
  SurfaceMesh hollow = wall.surface;
  hollow.facets.erase(
      hollow.facets.begin(),
      hollow.facets.begin() + static_cast<std::ptrdiff_t>(film.facets.size()));
  EXPECT_LT(enclosed_volume(hollow), 0.0);  // its normals point into the void
  // Outside a sphere nothing limits the wall, inside its radius does.
  EXPECT_EQ(wall_of(film, 3.0, walls::WallSide::Outside).safe.limit,
            walls::WallLimit::None);
  EXPECT_NEAR(wall_of(film, 0.5, walls::WallSide::Inside).safe.value, 0.9,
              0.03);
  EXPECT_FALSE(wall_of(film, 1.2, walls::WallSide::Inside).safe.asked <
               wall_of(film, 1.2, walls::WallSide::Inside).safe.value);
}

// Weyl's tube formula: V = t A + t^3 / 12 x (integral of K), exact for walls
// whose rims are normal to the film. Without corrections, which set in at
// another error on each mesh.
double plain_volume(const SurfaceMesh& film, double thickness) {
  return walls::thicken(
             film, {.thickness = Expression(thickness), .max_corrections = 0})
      .volume;
}

TEST(Thicken, VolumeIsThatOfTheTubeFormula) {
  const double t = 0.5;
  std::array<double, 3> error{};
  for (int i = 0; i < 3; ++i) {
    const double exact = 4.0 * kPi * t * (1.0 + t * t / 12.0);
    error[i] = std::abs(plain_volume(shapes::sphere(1.0, 2 + i), t) - exact);
  }
  EXPECT_GT(std::log2(error[1] / error[2]), kSecondOrder);
  for (int i = 0; i < 3; ++i) {
    const double half = 0.6;
    const double area = kPi * (2.0 * half + std::sinh(2.0 * half));
    const double gauss = -4.0 * kPi * std::tanh(half);
    const double exact = t * area + t * t * t / 12.0 * gauss;
    error[i] = std::abs(plain_volume(catenoid(24 << i), t) - exact);
  }
  EXPECT_GT(std::log2(error[1] / error[2]), kSecondOrder);
  for (int i = 0; i < 3; ++i) {
    const int n = 24 << i;
    const SurfaceMesh tube = shapes::cylinder_sheet(
        1.0, 1.5, {.rows = n / 4, .columns = n, .around = true});
    error[i] = std::abs(plain_volume(tube, t) - 2.0 * kPi * 1.5 * t);
  }
  EXPECT_GT(std::log2(error[1] / error[2]), kSecondOrder);
}

TEST(Thicken, OneSidedWallsKeepTheFilmVertexForVertex) {
  const SurfaceMesh film = catenoid(24);
  const auto n = static_cast<int>(film.points.size());
  const walls::ThickWall inside = wall_of(film, 0.2, walls::WallSide::Inside);
  const walls::ThickWall outside = wall_of(film, 0.2, walls::WallSide::Outside);
  for (int v = 0; v < n; ++v) {
    EXPECT_EQ(inside.surface.points[v], film.points[v]);
    EXPECT_EQ(outside.surface.points[n + v], film.points[v]);
    EXPECT_EQ(inside.trace[v].vertex, v);
    EXPECT_EQ(inside.trace[n + v].vertex, v);
    EXPECT_EQ(inside.trace[v].across, 1.0);
    EXPECT_EQ(inside.trace[n + v].across, 0.0);
    EXPECT_LT(inside.surface.points[n + v].head<2>().norm(),
              outside.surface.points[v].head<2>().norm());
  }
}

TEST(Thicken, LabelsSidesAndRims) {
  // Two labels side by side on one plane, the rim at y = 0 named.
  SurfaceMesh film = plane();
  film.labels = {"left", "right"};
  for (std::size_t f = 0; f < film.facets.size(); ++f) {
    film.facet_label[f] = static_cast<int>(f / 2) % 8 < 4 ? 0 : 1;
  }
  walls::ThickenOptions options{.thickness = Expression(0.25)};
  options.rims = {{"base", {0, 1, 2, 3, 4, 5, 6, 7, 8}}};
  const walls::ThickWall wall = walls::thicken(film, options);
  EXPECT_TRUE(wall.findings.empty());
  const std::vector<std::string> expected = {
      "left",          "right",          "left/back",   "right/back",
      "left/rim:base", "right/rim:base", "right/rim:1", "left/rim:1"};
  EXPECT_EQ(wall.surface.labels, expected);
  std::map<std::string, double> area;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    area[expected[i]] = surface_area(wall.surface, static_cast<int>(i));
  }
  EXPECT_NEAR(area["left/rim:base"] + area["right/rim:base"], 0.25, kRounding);
  EXPECT_NEAR(area["right/rim:1"] + area["left/rim:1"], 0.75, kRounding);
  EXPECT_NEAR(area["left"], area["left/back"], kRounding);
  for (std::size_t p = 2 * film.points.size(); p < wall.trace.size(); ++p) {
    EXPECT_EQ(wall.trace[p].across, 0.5);  // two rows of cells of edge 1/8
  }
}

TEST(Thicken, ThicknessMayVary) {
  const SurfaceMesh film = plane();
  const walls::ThickWall wall = walls::thicken(
      film, {.thickness = Expression::parse("0.1 + 0.1 * x", {"x", "y", "z"})});
  expect_promised(wall, "wedge");
  EXPECT_NEAR(wall.volume, 0.15, 1e-3);  // faces tilted by 0.05 each
  const walls::ThickWall bent = walls::thicken(
      catenoid(48),
      {.thickness = Expression::parse("0.3 + 0.2 * z", {"x", "y", "z"})});
  expect_promised(bent, "catenoid");
}

TEST(Thicken, GapsLimitTheThickness) {
  const SurfaceMesh film = joined(plane(), plane(0.4));
  const walls::ThickWall wall = wall_of(film, 0.19);
  expect_promised(wall, "two planes");
  EXPECT_EQ(wall.safe.limit, walls::WallLimit::Gap);
  EXPECT_NEAR(wall.safe.value, 0.2, 0.002);
  const walls::ThickWall closed = wall_of(film, 0.42);
  EXPECT_FALSE(closed.findings.empty());
  EXPECT_LT(closed.safe.value, closed.safe.asked);
  EXPECT_NE(closed.safe.message.find("too near"), std::string::npos);
  // A sheet's edge above another sheet, which no normal meets.
  SurfaceMesh upright = plane();
  for (Vec3& p : upright.points) {
    p = Vec3(p.x(), 0.5, 0.3 + p.y());
  }
  EXPECT_NEAR(wall_of(joined(plane(), upright), 0.1).safe.value, 0.15, 0.002);
}

TEST(Thicken, CreasesAreMitred) {
  const SurfaceMesh film = shapes::box(Vec3(1, 1, 1), 3);
  EXPECT_NEAR(wall_of(film, 0.1).volume, std::pow(1.1, 3) - std::pow(0.9, 3),
              kRounding);
  EXPECT_NEAR(wall_of(film, 0.1, walls::WallSide::Outside).volume,
              std::pow(1.2, 3) - 1.0, kRounding);
}

// The place that is asked lies within rounding of its own facet.
TEST(Thicken, CreasesLimitAsMuchHoweverTheyLie) {
  const SurfaceMesh film = shapes::box(Vec3(1, 1, 1), 3);
  const double upright = wall_of(film, 0.1).safe.value;
  EXPECT_GT(upright, 0.2);
  for (int k = 1; k < 6; ++k) {
    SurfaceMesh turned = film;
    const Mat3 turn = Eigen::AngleAxisd(0.37 * k, Vec3(1, 2, k).normalized())
                          .toRotationMatrix();
    for (Vec3& p : turned.points) {
      p = turn * p + Vec3(300, -70, 20);
    }
    EXPECT_NEAR(wall_of(turned, 0.1).safe.value, upright, 0.03 * upright);
  }
}

TEST(Thicken, SameBitsAgain) {
  const SurfaceMesh film = catenoid(24);
  const walls::ThickWall a = wall_of(film, 0.7);
  const walls::ThickWall b = wall_of(film, 0.7);
  EXPECT_EQ(a.surface.points, b.surface.points);
  EXPECT_EQ(a.surface.facets, b.surface.facets);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.safe.value, b.safe.value);
}

TEST(Thicken, UnusedPointsAreDropped) {
  SurfaceMesh film = plane();
  film.points.insert(film.points.begin(), Vec3(9, 9, 9));
  for (Triangle& f : film.facets) {
    f = {f[0] + 1, f[1] + 1, f[2] + 1};
  }
  const walls::ThickWall wall = wall_of(film, 0.1);
  EXPECT_EQ(wall.trace.front().vertex, 1);
  EXPECT_TRUE(wall.findings.empty());
}

template <typename Wrong>
void expect_refused(const SurfaceMesh& film,
                    const walls::ThickenOptions& options,
                    const std::string& words) {
  try {
    walls::thicken(film, options);
    ADD_FAILURE() << "accepted; expected: " << words;
  } catch (const Wrong& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
        << error.what();
  }
}

TEST(Thicken, RefusesBadThickness) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double t : {0.0, -1.0, nan, infinity}) {
    expect_refused<InvalidInput>(plane(), {.thickness = Expression(t)},
                                 "vertex 0");
  }
  const auto parse = [](const char* text) {
    return Expression::parse(text, {"x", "y", "z", "u"});
  };
  expect_refused<InvalidInput>(plane(), {.thickness = parse("0.99 - x")},
                               "vertex 8");
  expect_refused<InvalidInput>(plane(), {.thickness = parse("1 / x")},
                               "vertex 0");
  expect_refused<InvalidInput>(plane(), {.thickness = parse("u")},
                               "other than x, y and z");
}

TEST(Thicken, RefusesWhatHasNoTwoSides) {
  const walls::ThickenOptions options{.thickness = Expression(0.1)};
  expect_refused<InvalidInput>({}, options, "no facets");
  SurfaceMesh fan;  // three films on one edge
  fan.labels = {"a", "b", "c"};
  fan.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  fan.facets = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  fan.facet_label = {0, 1, 2};
  expect_refused<MeshError>(fan, options, "\"a\", \"b\", \"c\"");
  expect_refused<MeshError>(fan, options, "(0, 0, 0.5)");
  SurfaceMesh turned = plane();
  std::swap(turned.facets[5][0], turned.facets[5][1]);
  expect_refused<MeshError>(turned, options, "opposite sides");
  SurfaceMesh tie;  // two facets on one point
  tie.labels = {"tie"};
  tie.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  tie.facets = {{0, 1, 2}, {0, 3, 4}};
  tie.facet_label = {0, 0};
  expect_refused<MeshError>(tie, options, "one point only");
}

TEST(Thicken, RefusesBrokenArrays) {
  const walls::ThickenOptions options{.thickness = Expression(0.1)};
  SurfaceMesh film = plane();
  film.facets[3][1] = 1000;
  expect_refused<InvalidInput>(film, options, "corner 1000");
  film = plane();
  film.facet_label.pop_back();
  expect_refused<InvalidInput>(film, options, "labels");
  film = plane();
  film.facet_label[2] = 7;
  expect_refused<InvalidInput>(film, options, "label 7");
  film = plane();
  film.points[4].y() = std::numeric_limits<double>::quiet_NaN();
  expect_refused<InvalidInput>(film, options, "point 4");
  film = plane();
  film.points[4] = film.points[5];
  expect_refused<InvalidInput>(film, options, "no area");
  film = plane();
  film.labels.emplace_back("web/back");
  expect_refused<InvalidInput>(film, options, "web/back");
  walls::ThickenOptions wrong{.thickness = Expression(0.1)};
  wrong.rims = {{"base", {-3}}};
  expect_refused<InvalidInput>(plane(), wrong, "vertex -3");
}

}  // namespace
}  // namespace meniscus::thicken_test
