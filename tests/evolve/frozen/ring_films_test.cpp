// Rings between rims, films nested in each other, and the gap between them.
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/films/ruled_band.h"
#include "evolve/frozen/film_model.h"
#include "evolve/frozen/gap_between.h"
#include "evolve/start/start_complex.h"
#include "tests/support/check_complex.h"

namespace meniscus::ring_films_test {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kRingEdge = 0.15;
/// Of flat facets and polygons of this edge on circles of radius 0.6 and 1.
constexpr double kRingFacets = 0.01;

/// Two coaxial tubes, 0.8 long: the outer between circles of radius 1 (the
/// upper one `grown` larger), the inner between circles of radius 0.6, rings
/// between them; inside the inner one a void with caps of its own.
films::FilmSystem tube(double grown = 0.0, double lifted = 0.0) {
  films::FilmSystem system;
  system.curves = {
      {"out_low", curves::Circle{{0, 0, 0}, Vec3::UnitZ(), 1.0}},
      {"out_high", curves::Circle{{0, 0, 0.8}, Vec3::UnitZ(), 1.0 + grown}},
      {"in_low", curves::Circle{{0, 0, lifted}, Vec3::UnitZ(), 0.6}},
      {"in_high", curves::Circle{{0, 0, 0.8 - lifted}, Vec3::UnitZ(), 0.6}}};
  system.films = {
      {"outer", films::FilmKind::Branch, {"out_low", "out_high"}, 1.0, {}},
      {"inner", films::FilmKind::Branch, {"in_low", "in_high"}, 1.0, {}}};
  system.caps = {{"low", "out_low", "in_low"},
                 {"high", "out_high", "in_high"},
                 {"low_lid", "in_low"},
                 {"high_lid", "in_high"}};
  system.bodies = {
      {"wall", {"outer", "inner", "low", "high"}, 1.55, {}},
      {"hollow", {"inner", "low_lid", "high_lid"}, 0.95, {}, true}};
  return system;
}

double area_of(const frozen::FilmModel& model, const Points& points,
               const std::string& label) {
  const SurfaceMesh mesh = model.fine_mesh(points);
  return surface_area(mesh, mesh.label_of(label));
}

TEST(Ring, BetweenCirclesOfOnePlaneIsFlatAndHasItsArea) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(tube(), {.edge = kRingEdge});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const Points& points = model.reference().points;
  EXPECT_NEAR(area_of(model, points, "high"), kHalfTurn * (1.0 - 0.36),
              kRingFacets);
  const SurfaceMesh mesh = model.fine_mesh(points);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (mesh.facet_label[f] == mesh.label_of("high")) {
      for (const int v : mesh.facets[f]) {
        EXPECT_NEAR(mesh.points[v].z(), 0.8, 1e-12);
      }
    }
  }
  test_films::check_complex(start::build_start(tube(), kRingEdge));
}

TEST(Ring, BetweenPlanesIsAFrustum) {
  constexpr double kLift = 0.15;
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(tube(0.0, kLift), {.edge = kRingEdge});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  const double slant = std::hypot(0.4, kLift);
  EXPECT_NEAR(area_of(model, model.reference().points, "low"),
              kHalfTurn * 1.6 * slant, kRingFacets * kHalfTurn);
}

/// A film with a bore of `radius` through it, whose mouths are `tilted` against
/// each other.
films::FilmSystem bored(double radius, double tilted) {
  films::FilmSystem system = tube();
  system.curves[2].shape = curves::Circle{{0, 0, 0}, Vec3::UnitZ(), radius};
  system.curves[3].shape =
      curves::Circle{{0, 0, 0.8}, Vec3(tilted, 0, -1), radius};
  system.films.resize(1);
  system.caps = {{"low", "out_low", "in_low"},
                 {"high", "out_high", "in_high"},
                 {"bore", "in_low", "in_high"}};
  system.bodies = {{"wall", {"outer", "low", "high", "bore"}, 1.55, {}}};
  return system;
}

/// Vertices and mid-sides alike lie about the z axis.
void expect_cylinder(const QuadraticSurface& surface, const char* label,
                     double radius, double tolerance) {
  const int wanted = surface.base.label_of(label);
  for (std::size_t f = 0; f < surface.base.facets.size(); ++f) {
    for (int k = 0; surface.base.facet_label[f] == wanted && k < 3; ++k) {
      const Vec3& corner = surface.base.points[surface.base.facets[f][k]];
      const Vec3& middle = surface.mid[surface.facet_edges[f][k]];
      EXPECT_NEAR(corner.head<2>().norm(), radius, tolerance);
      EXPECT_NEAR(middle.head<2>().norm(), radius, tolerance);
    }
  }
}

// At the design that was frozen and at others.
TEST(Ring, BetweenEqualCirclesIsTheirCylinder) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      bored(0.5, 0.0), {.edge = kRingEdge, .refinements = 2});
  ASSERT_FALSE(model.reference().failure) << model.reference().failure->message;
  for (const double radius : {0.5, 0.45}) {
    const settle::FilmState state = model.settle(bored(radius, 0.0));
    ASSERT_FALSE(state.failure) << state.failure->message;
    const QuadraticSurface surface = model.surface(state.points);
    expect_cylinder(surface, "bore", radius, 1e-12);
    EXPECT_NEAR(area_of(model, state.points, "bore"),
                2.0 * kHalfTurn * radius * 0.8, kRingFacets);
  }
}

/// A circle as `count` arcs, the first of which begins at angle `from`.
curves::Polyline arcs(const Vec3& center, double radius, int count,
                      double from) {
  curves::Polyline line;
  const auto at = [&](double turns) -> Vec3 {
    const double angle = from + 2.0 * kHalfTurn * turns;
    return center + radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
  };
  for (int k = 0; k < count; ++k) {
    line.corners.push_back(at(static_cast<double>(k) / count));
    line.via.emplace_back(at((k + 0.5) / count));
  }
  return line;
}

// Drawn in arcs, in as many or not, and begun at another place.
TEST(Ring, BetweenCirclesDrawnAsArcsIsTheirCylinder) {
  for (const auto& [low, high, turned] :
       {std::tuple{2, 2, 0.5}, {4, 4, 0.2}, {3, 2, 1.1}, {2, 2, 1.5}}) {
    films::FilmSystem system = bored(0.5, 0.0);
    system.curves[2].shape = arcs({0, 0, 0}, 0.5, low, 0.1);
    system.curves[3].shape = arcs({0, 0, 0.8}, 0.5, high, 0.1 + turned);
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = kRingEdge});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    const QuadraticSurface surface = model.surface(model.reference().points);
    expect_cylinder(surface, "bore", 0.5, 1e-11);
  }
}

// Real corners are met by corners, also where a turn would shorten the lines.
TEST(Ring, BetweenTurnedPolygonsGoesFromCornerToCorner) {
  const auto square = [](double height, double turned) {
    curves::Polyline line = arcs({0, 0, height}, 0.5, 4, turned);
    line.via.assign(4, std::nullopt);
    return line;
  };
  const std::vector<curves::Curve> curves = {{"low", square(0.0, 0.0)},
                                             {"high", square(0.8, 0.4)}};
  const films::RuledBand band = films::match_band(curves, 0, 1);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(band.partner_of_outer(0.25 * k), 0.25 * k);
  }
}

TEST(Ring, StaysFlatWhereItsRimsGo) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(tube(), {.edge = kRingEdge});
  const settle::FilmState moved = model.settle(tube(0.2));
  ASSERT_FALSE(moved.failure) << moved.failure->message;
  EXPECT_NEAR(area_of(model, moved.points, "high"), kHalfTurn * (1.44 - 0.36),
              2.0 * kRingFacets);
}

// The solid is what lies between the films; the void is left out, its lids too.
TEST(Ring, ClosesASolidAroundAVoid) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(tube(), {.edge = kRingEdge});
  const SurfaceMesh part = model.boundary(model.reference().points);
  EXPECT_TRUE(check_surface(part).empty());
  EXPECT_NEAR(enclosed_volume(part), 1.55, 1e-6);
  std::vector<std::string> used;
  for (const int label : part.facet_label) {
    used.push_back(part.labels[static_cast<std::size_t>(label)]);
  }
  EXPECT_THAT(used, testing::Not(testing::Contains("low_lid")));
  EXPECT_THAT(used, testing::Contains("inner"));
}

TEST(Ring, ToACurveThatDoesNotExistIsRefused) {
  films::FilmSystem system = tube();
  system.caps[0].inner = "nowhere";
  EXPECT_THROW(start::build_start(system, kRingEdge), InvalidInput);
}

/// Two parallel squares of side 1, n x n x 2 facets each, `apart`; the upper
/// one sways by `wave`.
SurfaceMesh sheets(double apart, double wave = 0.0) {
  constexpr int kSide = 8;
  SurfaceMesh mesh;
  mesh.labels = {"lower", "upper"};
  for (int s = 0; s < 2; ++s) {
    const int first = static_cast<int>(mesh.points.size());
    for (int j = 0; j <= kSide; ++j) {
      for (int i = 0; i <= kSide; ++i) {
        const double x = static_cast<double>(i) / kSide + 0.01 * s;
        const double y = static_cast<double>(j) / kSide + 0.02 * s;
        mesh.points.emplace_back(
            x, y, s * (apart + wave * std::sin(3.0 * x) * std::cos(2.0 * y)));
      }
    }
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const int a = first + j * (kSide + 1) + i;
        const int c = a + kSide + 2;
        mesh.facets.push_back({a, a + 1, c});
        mesh.facets.push_back({a, c, c - 1});
        mesh.facet_label.insert(mesh.facet_label.end(), 2, s);
      }
    }
  }
  return mesh;
}

TEST(Gap, OfParallelSheetsIsTheirDistanceLessTheSmoothing) {
  constexpr double kApart = 0.3;
  for (const double smoothing : {1e-2, 1e-3, 1e-4}) {
    const frozen::FilmResponse gap =
        frozen::gap_between(sheets(kApart), 0, 1, smoothing);
    EXPECT_LE(gap.value, kApart + 1e-15);
    // 8 x 9 edges along each side and 64 across, of two sheets.
    EXPECT_GE(gap.value, kApart - smoothing * std::log(416.0) - 1e-12);
  }
}

TEST(Gap, HasTheDerivativeOfItsDifferences) {
  const SurfaceMesh mesh = sheets(0.3, 0.1);
  const frozen::FilmResponse gap = frozen::gap_between(mesh, 0, 1, 0.01);
  Points way;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const auto t = static_cast<double>(v);
    way.emplace_back(std::sin(1.3 * t), std::cos(0.7 * t), std::sin(2.9 * t));
  }
  constexpr double kStep = 2e-5;
  const auto at = [&](double s) {
    SurfaceMesh moved = mesh;
    for (std::size_t v = 0; v < way.size(); ++v) {
      moved.points[v] += s * way[v];
    }
    return frozen::gap_between(moved, 0, 1, 0.01).value;
  };
  double exact = 0.0;
  for (std::size_t v = 0; v < way.size(); ++v) {
    exact += gap.by.points[v].dot(way[v]);
  }
  // The derivatives at all vertices nearly cancel along this way, so that the
  // differences are extrapolated.
  const auto slope = [&](double s) { return (at(s) - at(-s)) / (2.0 * s); };
  EXPECT_NEAR((4.0 * slope(0.5 * kStep) - slope(kStep)) / 3.0, exact,
              1e-6 * std::abs(exact));
}

TEST(Gap, OfFilmsThatCrossOrTouchIsRefusedWithThePlace) {
  for (const double apart : {-0.02, 0.0}) {
    try {
      frozen::gap_between(sheets(apart, 0.1), 0, 1, 0.01);
      FAIL() << "not refused at " << apart;
    } catch (const InvalidInput& error) {
      EXPECT_THAT(error.what(), testing::ContainsRegex("cross|touch"));
      EXPECT_THAT(error.what(), testing::HasSubstr("'lower' and 'upper'"));
    }
  }
  EXPECT_THROW(frozen::gap_between(sheets(0.1), 0, 0, 0.01), InvalidInput);
  EXPECT_THROW(frozen::gap_between(sheets(0.1), 0, 2, 0.01), InvalidInput);
  EXPECT_THROW(frozen::gap_between(sheets(0.1), 0, 1, 0.0), InvalidInput);
}

// Through the film: rims move, both films follow, the gap with them.
TEST(Gap, OfSettledFilmsHasAnExactDerivative) {
  const frozen::FilmModel model =
      frozen::FilmModel::freeze(tube(), {.edge = 0.25, .refinements = 0});
  ASSERT_FALSE(model.reference().failure);
  const auto gap_at = [&](double grown) {
    return model.gap(model.settle(tube(grown)).points, "outer", "inner", 0.02);
  };
  constexpr double kAt = 0.07;
  constexpr double kStep = 1e-5;
  const settle::FilmState state = model.settle(tube(kAt));
  films::FilmSystem rates = tube();
  for (curves::Curve& curve : rates.curves) {
    curve.shape = curves::Circle{Vec3::Zero(), Vec3::Zero(),
                                 curve.name == "out_high" ? 1.0 : 0.0};
  }
  for (films::BodySpec& body : rates.bodies) {
    body.volume = 0.0;
  }
  for (films::FilmSpec& film : rates.films) {
    film.tension = 0.0;
  }
  const frozen::FilmResponse gap = gap_at(kAt);
  const auto back = model.transpose(state, tube(kAt), {gap.by});
  const double exact = model.rate(back[0], tube(kAt), rates);
  const double differences =
      (gap_at(kAt + kStep).value - gap_at(kAt - kStep).value) / (2.0 * kStep);
  EXPECT_NEAR(differences, exact, 1e-5 * std::abs(exact) + 1e-8);
  // Forwards through the same system: the same number.
  const std::vector<Points> moves = model.tangents(state, tube(kAt), {rates});
  double forward = 0.0;
  for (std::size_t v = 0; v < moves[0].size(); ++v) {
    forward += gap.by.points[v].dot(moves[0][v]);
  }
  EXPECT_NEAR(forward, exact, 1e-10 * (1.0 + std::abs(exact)));
}

}  // namespace
}  // namespace meniscus::ring_films_test
