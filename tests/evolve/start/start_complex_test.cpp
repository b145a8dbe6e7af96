#include "evolve/start/start_complex.h"

#include <cmath>
#include <numbers>
#include <regex>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "evolve/films/body_sides.h"
#include "evolve/start/disk_fill.h"
#include "tests/support/check_complex.h"
#include "tests/support/systems.h"

namespace meniscus::start_complex_test {
namespace {

using systems::Part;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kHalfCircle = std::numbers::pi;
constexpr double kCapAngle = 28.0;  // [deg] asked of every cap

std::string refusal(const films::FilmSystem& system, double edge = 0.4) {
  try {
    start::build_start(system, edge);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

// Euler characteristic 2, outward, no finding but the raw start's needles.
void expect_sound(const films::FilmComplex& complex) {
  test_films::check_complex(complex);
  for (const films::ComplexBody& body : complex.bodies) {
    const SurfaceMesh shell = films::body_surface(complex, body);
    EXPECT_EQ(systems::euler_characteristic(shell), 2);
    EXPECT_GT(enclosed_volume(shell), 0.0);
    const auto findings = check_surface(shell);
    EXPECT_TRUE(findings.empty()) << summary(findings);
  }
}

TEST(StartComplex, BracketIsTheHullOfItsCircles) {
  double last = 0.0;
  for (const double edge : {30.0, 8.0, 4.0}) {
    const films::FilmComplex complex =
        start::build_start(systems::bracket(), edge);
    expect_sound(complex);
    const auto caps = systems::quality(complex, Part::Caps);
    EXPECT_GT(caps.smallest_angle, kCapAngle);
    EXPECT_LT(caps.longest, 1.5 * edge);
    EXPECT_NEAR(caps.mean / edge, 1.0, edge > 20.0 ? 0.4 : 0.15);
    // Inscribed polygons grow towards the true hull.
    const double volume =
        enclosed_volume(films::body_surface(complex, complex.bodies[0]));
    EXPECT_GT(volume, last);
    last = volume;
    for (const films::BodySide& side : complex.bodies[0].sides) {
      EXPECT_EQ(side.sign, 1);
    }
  }
}

TEST(StartComplex, CapsFaceOutward) {
  const films::FilmComplex complex =
      start::build_start(systems::bracket(), 8.0);
  const int pad = complex.mesh.label_of("support_pad");
  for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
    if (complex.mesh.facet_label[f] == pad) {
      EXPECT_LT(area_vector2(complex.mesh, static_cast<int>(f)).z(), 0.0);
    }
  }
}

TEST(StartComplex, CylinderHasItsVolumeAndArea) {
  const films::FilmComplex complex =
      start::build_start(systems::cylinder(3.0), 0.1);
  expect_sound(complex);
  // Regular n-gons of 62 corners inscribed: 1 - 2 pi^2 / (3 n^2).
  constexpr double kInscribed = 2e-3;
  EXPECT_NEAR(enclosed_volume(films::body_surface(complex, complex.bodies[0])) /
                  (3.0 * kHalfCircle),
              1.0, kInscribed);
  EXPECT_NEAR(surface_area(complex.mesh, 0) / (6.0 * kHalfCircle), 1.0,
              kInscribed);
}

TEST(StartComplex, LoftJoinsSquareAndCircleWithLittleTwist) {
  for (const double turn : {0.0, 1.0}) {
    films::FilmSystem system = systems::strut();
    if (turn > 0.0) {  // the other way round
      std::get<curves::Circle>(system.curves[1].shape).normal = -Vec3::UnitZ();
    }
    const films::FilmComplex complex = start::build_start(system, 0.3);
    expect_sound(complex);
    for (std::size_t f = 0; f < complex.mesh.facets.size(); ++f) {
      const auto& mesh = complex.mesh;
      if (mesh.facet_label[f] != 0) {
        continue;
      }
      // No edge is much longer than the distance of the planes and offsets.
      for (int k = 0; k < 3; ++k) {
        const Vec3 d = mesh.points[mesh.facets[f][k]] -
                       mesh.points[mesh.facets[f][(k + 1) % 3]];
        EXPECT_LT(d.norm(), 4.6);
      }
    }
  }
}

TEST(StartComplex, LoftAroundABendPairsInnerWithInner) {
  films::FilmSystem system;
  system.curves = {{"a", curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 1.0}},
                   {"b", curves::Circle{Vec3(3, 0, 3), Vec3::UnitX(), 1.0}}};
  system.films = {{"bend", films::FilmKind::Loft, {"a", "b"}, 1.0}};
  const films::FilmComplex complex = start::build_start(system, 0.2);
  test_films::check_complex(complex);
  double longest = 0.0;
  for (const Triangle& t : complex.mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (complex.mesh.points[t[k]] -
                                   complex.mesh.points[t[(k + 1) % 3]])
                                      .norm());
    }
  }
  EXPECT_LT(longest, 4.0 * std::sqrt(2.0) + 0.1);  // the outer chord
}

TEST(StartComplex, OpenFilmNeedsNoBody) {
  const films::FilmComplex complex =
      start::build_start(systems::catenoid(), 0.2);
  test_films::check_complex(complex);
  EXPECT_TRUE(complex.bodies.empty());
  EXPECT_EQ(systems::euler_characteristic(complex.mesh), 0);
}

TEST(StartComplex, BodiesShareABulkheadWithOppositeSigns) {
  const films::FilmComplex complex =
      start::build_start(systems::bulkhead(), 0.3);
  expect_sound(complex);
  int product = 1;
  for (const films::ComplexBody& body : complex.bodies) {
    for (const films::BodySide& side : body.sides) {
      if (complex.surfaces[side.surface].name == "wall") {
        product *= side.sign;
      } else {
        EXPECT_EQ(side.sign, 1);
      }
    }
  }
  EXPECT_EQ(product, -1);
}

/// A cylinder with a hollow in its bottom, whose rim runs either way around.
films::FilmSystem hollowed(double way) {
  films::FilmSystem system = systems::cylinder(2.0);
  system.curves.push_back(
      {"rim", curves::Circle{Vec3(0.2, 0.0, 0.0), way * Vec3::UnitZ(), 0.5}});
  system.films.push_back({"vault", films::FilmKind::Disk, {"rim"}, 1.0});
  system.caps[0].more = {"rim"};
  system.caps.push_back({"lid", "rim"});
  system.bodies[0].enclosed_by.push_back("vault");
  system.bodies.push_back({"hollow", {"vault", "lid"}, 0.15, {}, true});
  return system;
}

TEST(StartComplex, HollowsGoIntoTheBodyThatTheirFilmIsOf) {
  for (const double way : {1.0, -1.0}) {
    const films::FilmSystem system = hollowed(way);
    const films::FilmComplex complex = start::build_start(system, 0.2);
    expect_sound(complex);
    double together = 0.0;
    for (const films::ComplexBody& body : complex.bodies) {
      together += enclosed_volume(films::body_surface(complex, body));
    }
    const films::FilmComplex whole =
        start::build_start(systems::cylinder(2.0), 0.2);
    EXPECT_NEAR(together,
                enclosed_volume(films::body_surface(whole, whole.bodies[0])),
                0.02);
    const double hollow =
        enclosed_volume(films::body_surface(complex, complex.bodies[1]));
    EXPECT_NEAR(hollow, 0.15, 0.01);
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
      EXPECT_GT(complex.mesh.points[v].z(), -1e-9);
    }
  }
}

/// Chords of the outer rim cut into the inner one, unless they are shorter.
TEST(StartComplex, RimsCloserThanTheirChordsBendAreCutFinely) {
  films::FilmSystem system;
  system.curves = {
      {"outer", curves::Circle{Vec3::Zero(), Vec3::UnitZ(), 10.0}},
      {"inner", curves::Circle{Vec3(0, 0, 3), Vec3::UnitZ(), 9.8}}};
  system.films = {{"film", films::FilmKind::Disk, {"outer", "inner"}, 1.0}};
  const films::FilmComplex complex = start::build_start(system, 5.0);
  test_films::check_complex(complex);
  EXPECT_EQ(systems::euler_characteristic(complex.mesh), 0);
  for (const curves::Curve& curve : complex.curves) {
    EXPECT_LT(curve.fineness, 1.0);
  }
  // Rims that are apart stay as they were, and such that do cross are told.
  std::get<curves::Circle>(system.curves[1].shape).radius = 5.0;
  for (const curves::Curve& curve : start::build_start(system, 5.0).curves) {
    EXPECT_EQ(curve.fineness, 1.0);
  }
  std::get<curves::Circle>(system.curves[1].shape).center.x() = 6.0;
  EXPECT_THROW(start::build_start(system, 5.0), Error);
}

TEST(StartComplex, BranchTakesStraightSidesToo) {
  films::FilmSystem system;
  curves::Rectangle base;
  base.width = 4.0;
  base.height = 2.0;
  base.normal = -Vec3::UnitZ();
  curves::Rectangle top = base;
  top.center = Vec3(0.3, 0.1, 3.0);
  top.normal = Vec3::UnitZ();
  top.width = 1.0;
  system.curves = {{"base", base}, {"top", top}};
  system.films = {{"skin", films::FilmKind::Branch, {"base", "top"}, 1.0}};
  system.caps = {{"floor", "base"}, {"lid", "top"}};
  system.bodies = {{"body", {"skin", "floor", "lid"}, {}, {}}};
  const films::FilmComplex complex = start::build_start(system, 0.3);
  expect_sound(complex);
  EXPECT_NEAR(enclosed_volume(films::body_surface(complex, complex.bodies[0])),
              3.0 / 6.0 * (8.0 + 4.0 * 2.5 * 2.0 + 2.0), 1e-9);
}

TEST(StartComplex, IsTheSameInEveryBit) {
  for (const films::FilmSystem& system :
       {systems::bracket(), systems::bulkhead()}) {
    const double edge = system.curves.size() == 3 ? 8.0 : 0.2;
    EXPECT_TRUE(systems::identical(start::build_start(system, edge),
                                   start::build_start(system, edge)));
  }
}

TEST(FillDisk, IsIsotropicForManyCurvesAndSizes) {
  for (int n = 12; n <= 120; n += 6) {
    Points rim;
    for (int i = 0; i < n; ++i) {
      const double a = 2.0 * kHalfCircle * i / n;
      rim.emplace_back(std::cos(a), std::sin(a), 0.0);
    }
    const SurfaceMesh disk = start::fill_disk(rim, 2.0 * kHalfCircle / n);
    EXPECT_EQ(systems::euler_characteristic(disk), 1) << n;
    EXPECT_EQ(systems::open_edges(disk), n);
    EXPECT_GT(systems::smallest_angle_deg(disk), kCapAngle) << n;
    EXPECT_NEAR(surface_area(disk), polygon_area_vector(rim).norm(), 1e-12);
  }
}

TEST(FillDisk, FillsAConcaveCurve) {
  // An L of unit width.
  const curves::Polygon shape{
      {{0, 0, 1}, {3, 0, 1}, {3, 1, 1}, {1, 1, 1}, {1, 3, 1}, {0, 3, 1}}};
  Points rim;
  for (const double t : curves::sample_parameters(shape, 0.2)) {
    rim.push_back(curves::point_at(shape, t));
  }
  const SurfaceMesh disk = start::fill_disk(rim, 0.2);
  EXPECT_NEAR(surface_area(disk), 5.0, 1e-12);
  EXPECT_GT(systems::smallest_angle_deg(disk), kCapAngle);
  for (std::size_t f = 0; f < disk.facets.size(); ++f) {
    EXPECT_GT(area_vector2(disk, static_cast<int>(f)).z(), 0.0);
  }
}

TEST(StartComplex, BranchesHaveRimsSideBySideInOnePlane) {
  // Two ends of a hexagonal barrel, and three windows on each of its sides.
  films::FilmSystem system;
  const auto corner = [](int k, double z) {
    return Vec3(10 * std::cos(k * kHalfCircle / 3),
                10 * std::sin(k * kHalfCircle / 3), z);
  };
  films::FilmSpec film{"barrel", films::FilmKind::Branch, {"low", "high"}};
  curves::Polygon low;
  curves::Polygon high;
  for (int k = 0; k < 6; ++k) {
    low.points.push_back(corner(k, 0.0));
    high.points.push_back(corner(k, 30.0));
  }
  system.curves = {{"low", low}, {"high", high}};
  double windows = 0.0;
  for (int k = 0; k < 6; ++k) {
    const Vec3 middle = 0.5 * (corner(k, 0.0) + corner(k + 1, 0.0));
    for (const double z : {6.0, 14.0, 23.0}) {
      const std::string name = fmt::format("window_{}_{}", k, z);
      const double radius = 0.12 * z + 1.0;
      system.curves.push_back(
          {name, curves::Circle{middle + z * Vec3::UnitZ(), middle, radius}});
      film.curves.push_back(name);
      windows += kHalfCircle * radius * radius;
    }
  }
  system.films = {film};
  const films::FilmComplex start = start::build_start(system, 0.5);
  // Flat sides less their windows, whose arcs are cut by chords.
  const double area = 6 * 10 * 30 - windows;
  EXPECT_NEAR(surface_area(start.mesh), area, 0.02 * windows);
  EXPECT_GT(surface_area(start.mesh), area);
}

TEST(StartComplex, NamesTheCurveThatIsOffTheHull) {
  films::FilmSystem system = systems::bracket();
  system.curves.push_back(
      {"inner", curves::Circle{Vec3(0, 0, 40), Vec3::UnitZ(), 5.0}});
  system.films[0].curves.push_back("inner");
  EXPECT_THAT(refusal(system, 8.0),
              AllOf(HasSubstr("'inner' is off the convex hull"),
                    HasSubstr("another kind")));
  // Half of a circle buried, too.
  system.curves.back() = {"inner",
                          curves::Circle{Vec3(0, 0, 90), Vec3(1, 0, 1), 60.0}};
  EXPECT_NE(refusal(system, 8.0), "");
}

TEST(StartComplex, RefusesWhatCannotBeBuilt) {
  films::FilmSystem system = systems::cylinder(2.0);
  system.bodies[0].enclosed_by.pop_back();
  EXPECT_THAT(refusal(system), AllOf(HasSubstr("cap 'top' encloses nothing")));
  system.caps.pop_back();
  EXPECT_THAT(refusal(system), AllOf(HasSubstr("'body' is not closed"),
                                     HasSubstr("'film'"), HasSubstr(", 2)")));
  system = systems::cylinder(2.0);
  system.films[0].curves[1] = "hihg";
  EXPECT_THAT(refusal(system), HasSubstr("'hihg', which does not exist"));
  system = systems::cylinder(2.0);
  system.bodies[0].enclosed_by[1] = "botom";
  EXPECT_THAT(refusal(system), HasSubstr("'botom'"));
  system = systems::cylinder(2.0);
  system.films[0].curves.pop_back();
  EXPECT_THAT(refusal(system), HasSubstr("has 1 curves"));
  system = systems::cylinder(2.0);
  system.bodies[0].volume = 3.0;
  EXPECT_THAT(refusal(system), HasSubstr("both volume and pressure"));
  system = systems::cylinder(2.0);
  system.curves[0].shape =
      curves::Polygon{{{1, 0, 0}, {0, 1, 0.5}, {-1, 0, 0}, {0, -1, 0.5}}};
  EXPECT_THAT(refusal(system), HasSubstr("is not planar"));
  system = systems::cylinder(2.0);
  system.films[0].tension = -1.0;
  EXPECT_THAT(refusal(system), HasSubstr("tension is -1"));
  EXPECT_THAT(refusal(systems::cylinder(2.0), 0.0),
              HasSubstr("edge length is 0"));
  EXPECT_THAT(refusal(systems::cylinder(0.0)), HasSubstr("no volume"));
}

TEST(StartComplex, RefusesACurveThatCrossesItself) {
  films::FilmSystem system;
  system.curves = {
      {"bow", curves::Polygon{{{0, 0, 0}, {3, 2, 0}, {3, 0, 0}, {0, 1, 0}}}}};
  system.films = {{"film", films::FilmKind::Disk, {"bow"}, 1.0}};
  EXPECT_THAT(refusal(system),
              AllOf(HasSubstr("bow"),
                    HasSubstr("crosses itself or another near (1, 0.666667, "
                              "0)")));
  // A spur that goes back along itself: nothing crosses.
  system.curves = {{"spur", curves::Polygon{{{0, 0, 0},
                                             {9, 0, 0},
                                             {9, 4, 0},
                                             {5, 4, 0},
                                             {5, 7, 0},
                                             {5, 5, 0},
                                             {0, 4, 0}}}}};
  system.films[0].curves = {"spur"};
  EXPECT_THAT(refusal(system),
              HasSubstr("crosses itself or another near (5, 5, 0)"));
}

// A raised rim whose right half hangs out over the right side, at x = 5.
TEST(StartComplex, SaysWhereRimsOfOneFilmCrossInThePlan) {
  films::FilmSystem system;
  system.curves = {
      {"outline",
       curves::Polygon{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}}},
      {"crest", curves::Circle{{4.9, 0, 2}, {0, 0, 1}, 2.0}}};
  system.films = {{"film", films::FilmKind::Disk, {"outline", "crest"}, 1.0}};
  const std::string text = refusal(system);
  std::smatch place;
  ASSERT_TRUE(std::regex_search(
      text, place, std::regex("or another near \\(([-0-9.]+), ([-0-9.]+), 0")))
      << text;
  EXPECT_EQ(std::stod(place[1]), 5.0) << text;
  EXPECT_NEAR(std::abs(std::stod(place[2])), 2.0, 0.05);  // on chords
}

}  // namespace
}  // namespace meniscus::start_complex_test
