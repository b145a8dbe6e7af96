// Films that slide on cylinders, spheres and cones, by their closed forms.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/edge_key.h"
#include "core/geometry/surface_mesh.h"
#include "evolve/energy/energy.h"
#include "evolve/frozen/film_model.h"
#include "evolve/settle/equilibrium.h"
#include "evolve/start/bent_fill.h"
#include "evolve/start/start_complex.h"
#include "evolve/start/wetted_faces.h"

namespace meniscus::bent_walls_test {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
constexpr double kTension = 2.0;
// Errors of flat facets fall with their square, by 4 a refinement.
constexpr double kSecondOrder = 3.4;
constexpr double kOnWall = 1e-13;  // of coordinates near 1

double radians(double degrees) { return degrees * kPi / 180.0; }

/// Of a sphere's part of a height.
double cap_volume(double radius, double height) {
  return kPi * height * height * (3.0 * radius - height) / 3.0;
}

/// A drop in its own frame: a system, its film's radius, the wetted area.
struct Drop {
  films::FilmSystem system;
  double radius = 0.0;  // below 0: bent the other way
  double wetted = 0.0;
};

const Vec3 kAxis = Vec3(0.3, -0.2, 1.0).normalized();
const Vec3 kOrigin = Vec3(0.4, -0.3, 0.2);

Vec3 on_axis(double z) { return kOrigin + z * kAxis; }

/// `up`: which way along the axis the film bulges, by its curve's normal.
films::FilmSystem on_wall(const films::FilmWall& wall, double angle, double z,
                          double radius, double volume, double up) {
  films::FilmSystem system;
  system.curves = {{"begin", curves::Circle{on_axis(z), up * kAxis, radius}}};
  system.films = {{"dome", films::FilmKind::Disk, {"begin"}, kTension}};
  system.caps = {{"face", "begin"}};
  system.caps[0].wall = wall;
  system.caps[0].wall->tension = -kTension * std::cos(angle);
  system.bodies = {{"drop", {"face", "dome"}, volume, {}}};
  return system;
}

films::FilmWall wall_of(films::WallKind kind) {
  return {.at = kOrigin,
          .normal = 3.0 * kAxis,  // any length
          .kind = kind,
          .radius = 1.0,
          .half_angle = radians(30.0)};
}

/// Upon a ball of radius 1: the angle between film and wall at their line, with
/// the centers c apart, is that of a triangle 1, r, c.
Drop on_ball(double angle, double r) {
  const double c = std::sqrt(1.0 + r * r - 2.0 * r * std::cos(angle));
  const double z = 0.5 * (1.0 + c * c - r * r) / c;
  const double volume = cap_volume(r, c + r - z) - cap_volume(1.0, 1.0 - z);
  // It begins on a smaller circle.
  const double begin = 0.5 * (1.0 + z);
  return {on_wall(wall_of(films::WallKind::Sphere), angle, begin,
                  std::sqrt(1.0 - begin * begin), volume, 1.0),
          r, 2.0 * kPi * (1.0 - z)};
}

/// In a bowl, whose film is a sphere about a place beyond the bowl's center.
Drop in_bowl(double angle, double r) {
  const double c = std::sqrt(1.0 + r * r + 2.0 * r * std::cos(angle));
  const double z = 0.5 * (1.0 + c * c - r * r) / c;
  const double volume = cap_volume(1.0, 1.0 - z) + cap_volume(r, z - (c - r));
  const double begin = 0.5 * (1.0 + z);
  return {on_wall(wall_of(films::WallKind::Sphere), angle, begin,
                  std::sqrt(1.0 - begin * begin), volume, -1.0),
          r, 2.0 * kPi * (1.0 - z)};
}

/// In a funnel: the film's polar angle at the wall is 30 deg + angle - 90 deg.
Drop in_funnel(double angle) {
  const double a = radians(30.0);
  const double polar = a + angle - 0.5 * kPi;
  const double out = std::tan(a);  // at z = 1
  const double r = out / std::sin(polar);
  const double cap =
      cap_volume(std::abs(r), std::abs(r) * (1.0 - std::cos(polar)));
  const double volume = kPi * out * out / 3.0 + (r > 0.0 ? cap : -cap);
  return {on_wall(wall_of(films::WallKind::Cone), angle, 0.8, 0.8 * std::tan(a),
                  volume, 1.0),
          r, kPi * out / std::cos(a)};
}

/// About the tip of a cone, down to a ring: the film's polar angle at the wall
/// is 120 deg - angle, at the ring 120 deg.
Drop on_tip(double angle) {
  const double a = radians(30.0);
  const double polar = a + 0.5 * kPi - angle;
  const double out = std::tan(a);  // at z = 1
  const double r = out / std::sin(polar);
  const double ring = 1.0 - r * std::cos(polar) - 0.5 * r;
  const double volume = 4.0 * kPi * r * r * r / 3.0 -
                        cap_volume(r, r * (1.0 - std::cos(polar))) -
                        cap_volume(r, 0.5 * r) - kPi * out * out / 3.0;
  Drop drop{on_wall(wall_of(films::WallKind::Cone), angle, 0.8,
                    0.8 * std::tan(a), volume, 1.0),
            r, kPi * out / std::cos(a)};
  films::FilmSystem& system = drop.system;
  system.curves.push_back(
      {"ring", curves::Circle{on_axis(ring), kAxis, std::sqrt(0.75) * r}});
  system.films[0].kind = films::FilmKind::Loft;
  system.films[0].curves.push_back("ring");
  system.caps.push_back({"lid", "ring"});
  system.bodies[0].enclosed_by.push_back("lid");
  return drop;
}

void expect_spherical(const Drop& drop, double accuracy,
                      const std::string& name) {
  std::vector<double> pressure_errors;
  std::vector<double> area_errors;
  for (const int refinements : {0, 1, 2}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        drop.system, {.edge = 0.28, .refinements = refinements});
    ASSERT_FALSE(model.reference().failure)
        << name << ": " << model.reference().failure->message;
    const settle::FilmReport& report = model.reference().report;
    EXPECT_EQ(report.index, 0) << name;
    pressure_errors.push_back(std::abs(
        report.bodies[0].pressure * drop.radius / (2.0 * kTension) - 1.0));
    area_errors.push_back(
        std::abs(model.areas(model.reference().points)[1] / drop.wetted - 1.0));
    // The face is on the wall, and its mesh has the volume but for lenses.
    const SurfaceMesh mesh = model.fine_mesh(model.reference().points);
    const films::BentWall wall = *drop.system.caps[0].wall->bent();
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      for (const int v : mesh.facets[f]) {
        if (mesh.labels[mesh.facet_label[f]] == "face") {
          EXPECT_NEAR(films::distance_outside(wall, mesh.points[v]), 0.0,
                      kOnWall)
              << name;
        }
      }
    }
  }
  EXPECT_LT(pressure_errors[2], accuracy) << name;
  EXPECT_LT(area_errors[2], accuracy) << name;
  for (const int k : {0, 1}) {
    EXPECT_GT(pressure_errors[k] / pressure_errors[k + 1], kSecondOrder)
        << name << " pressure " << pressure_errors[k];
    EXPECT_GT(area_errors[k] / area_errors[k + 1], kSecondOrder)
        << name << " area " << area_errors[k];
  }
}

TEST(BentWalls, ADropOnABallIsASphereAtItsAngle) {
  expect_spherical(on_ball(radians(80.0), 0.8), 5e-3, "80 deg");
  expect_spherical(on_ball(radians(120.0), 1.0), 5e-3, "120 deg");
}

TEST(BentWalls, ADropInABowlIsASphereAtItsAngle) {
  expect_spherical(in_bowl(radians(110.0), 1.2), 5e-3, "110 deg");
}

TEST(BentWalls, ADropOnAConeIsASphereAtItsAngle) {
  expect_spherical(in_funnel(radians(110.0)), 5e-3, "funnel");
  expect_spherical(in_funnel(radians(40.0)), 5e-3, "funnel that wets");
  expect_spherical(on_tip(radians(70.0)), 5e-3, "tip");
}

films::FilmSystem plug_in(double angle, double length, const Vec3& at) {
  const double r = -1.0 / std::cos(angle);  // hollow
  const double bowl = cap_volume(-r, -r - std::sqrt(r * r - 1.0));
  films::FilmSystem system;
  system.curves = {{"low", curves::Circle{on_axis(-0.5 * length), kAxis, 1.0}},
                   {"high", curves::Circle{on_axis(0.5 * length), kAxis, 1.0}}};
  system.films = {{"bottom", films::FilmKind::Disk, {"low"}, kTension},
                  {"top", films::FilmKind::Disk, {"high"}, kTension}};
  system.caps = {{.name = "face", .curve = "low", .more = {"high"}}};
  system.caps[0].wall = wall_of(films::WallKind::Cylinder);
  system.caps[0].wall->at = at;
  system.caps[0].wall->tension = -kTension * std::cos(angle);
  system.bodies = {
      {"plug", {"face", "bottom", "top"}, kPi * length - 2.0 * bowl, {}}};
  return system;
}

/// A plug of liquid in a tube, which goes where it likes along it.
TEST(BentWalls, APlugInATubeHasItsMenisci) {
  const double angle = radians(70.0);
  const double r = -1.0 / std::cos(angle);  // hollow
  const double length = 1.6;
  const films::FilmSystem system = plug_in(angle, length, kOrigin);
  std::vector<double> area_errors;
  for (const int refinements : {0, 1, 2}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        system, {.edge = 0.35, .refinements = refinements});
    ASSERT_FALSE(model.reference().failure)
        << model.reference().failure->message;
    EXPECT_EQ(model.reference().report.index, 0);
    EXPECT_NEAR(
        model.reference().report.bodies[0].pressure * r / (2.0 * kTension), 1.0,
        2e-3);  // next to no error to fall
    area_errors.push_back(std::abs(
        model.areas(model.reference().points)[2] / (2.0 * kPi * length) - 1.0));
  }
  EXPECT_LT(area_errors[2], 1e-3);
  for (const int k : {0, 1}) {
    EXPECT_GT(area_errors[k] / area_errors[k + 1], kSecondOrder);
  }
}

/// Rims whose points ran together on one side would cut the tube's discs off.
TEST(BentWalls, APlugOfAnyLengthStandsByCoarseEdges) {
  const double angle = radians(70.0);
  for (const double length : {8.0, 20.0}) {
    const frozen::FilmModel model = frozen::FilmModel::freeze(
        plug_in(angle, length, kOrigin), {.edge = 0.45, .refinements = 0});
    ASSERT_FALSE(model.reference().failure)
        << length << ": " << model.reference().failure->message;
    EXPECT_NEAR(model.reference().report.bodies[0].pressure,
                -2.0 * kTension * std::cos(angle), 0.03 * kTension)
        << length;
    EXPECT_NEAR(model.areas(model.reference().points)[2], 2.0 * kPi * length,
                0.6)
        << length;
  }
}

TEST(BentWalls, WhereATubesPointLiesAlongItsAxisCountsForNothing) {
  const double angle = radians(70.0);
  std::vector<double> pressures;
  std::vector<double> areas;
  for (const double along : {0.0, 1e5}) {
    const films::FilmSystem system =
        plug_in(angle, 2.0, kOrigin + along * kAxis);
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = 0.45, .refinements = 0});
    ASSERT_FALSE(model.reference().failure)
        << along << ": " << model.reference().failure->message;
    pressures.push_back(model.reference().report.bodies[0].pressure);
    areas.push_back(model.areas(model.reference().points)[2]);
    // A design with the wall that it has is none that moves it.
    EXPECT_FALSE(model.settle(system).failure);
    films::FilmSystem moved = system;
    moved.caps[0].wall->at += 0.1 * kAxis;
    EXPECT_FALSE(model.settle(moved).failure);
    moved.caps[0].wall->at += 1e-6 * kAxis.unitOrthogonal();
    EXPECT_THROW(model.settle(moved), InvalidInput);
  }
  EXPECT_NEAR(pressures[1], pressures[0], 1e-9 * std::abs(pressures[0]));
  EXPECT_NEAR(areas[1], areas[0], 1e-9 * areas[0]);
}

/// A ball 10,000 times as large as its drop's rim is nearly a plane.
TEST(BentWalls, ADropOnALargeBallIsThatOnAPlane) {
  const double angle = radians(80.0);
  const double radius = 10000.0;
  const double r = 1.0 / std::sin(angle);
  films::FilmWall wall = wall_of(films::WallKind::Sphere);
  wall.radius = radius;
  wall.at = on_axis(-radius);
  films::FilmSystem system =
      on_wall(wall, angle, -0.5 * 0.81 / radius, 0.9,
              cap_volume(r, r * (1.0 - std::cos(angle))), 1.0);
  std::vector<double> pressures;
  std::vector<double> areas;
  for (const bool plane : {false, true}) {
    if (plane) {
      system = on_wall({.at = kOrigin, .normal = kAxis}, angle, 0.0, 0.9,
                       cap_volume(r, r * (1.0 - std::cos(angle))), 1.0);
    }
    const frozen::FilmModel model =
        frozen::FilmModel::freeze(system, {.edge = 0.2, .refinements = 0});
    ASSERT_FALSE(model.reference().failure)
        << plane << ": " << model.reference().failure->message;
    pressures.push_back(model.reference().report.bodies[0].pressure);
    areas.push_back(model.areas(model.reference().points)[1]);
  }
  // By the rim's radius over the ball's.
  EXPECT_NEAR(pressures[0], pressures[1], 1e-3 * pressures[1]);
  EXPECT_NEAR(areas[0], areas[1], 1e-3 * areas[1]);
}

/// A design without a film that names the wall, not an error that ends a study.
TEST(BentWalls, ARimBeyondAnApexIsAFailedDesign) {
  const films::FilmComplex complex =
      start::build_start(in_funnel(radians(110.0)).system, 0.3);
  const energy::FilmEnergy energy(complex);
  ASSERT_TRUE(energy.space().has_bent_walls());
  Points base = complex.mesh.points;
  const Points directions = energy.space().directions(base);
  base[energy.space().walled()[0]] = on_axis(-1.0);
  const settle::FilmState state =
      settle::settle_along(energy, complex, energy::targets_of(complex), base,
                           directions, {}, 0.0, {});
  ASSERT_TRUE(state.failure);
  EXPECT_EQ(state.failure->kind, FailureKind::FilmNotFound);
  EXPECT_THAT(state.failure->message,
              HasSubstr("the rim on the wall of 'face' runs off it"));
}

/// Every edge of a closed strip has two facets but those of its rims.
void expect_filled(const SurfaceMesh& mesh, std::size_t rims, double area,
                   double accuracy) {
  std::map<Edge, int> sides;
  double sum = 0.0;
  for (const Triangle& t : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      ++sides[edge_key(t[k], t[(k + 1) % 3])];
    }
    sum += 0.5 * (mesh.points[t[1]] - mesh.points[t[0]])
                     .cross(mesh.points[t[2]] - mesh.points[t[0]])
                     .norm();
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : sides) {
    EXPECT_LE(count, 2);
    open += count == 1 ? 1 : 0;
  }
  EXPECT_EQ(open, rims);
  EXPECT_NEAR(sum, area, accuracy * area);
}

Points ring(double z, int count, double slope) {
  Points result;
  const Vec3 x = kAxis.unitOrthogonal();
  for (int k = 0; k < count; ++k) {
    const double t = 2.0 * kPi * k / count;
    result.emplace_back(on_axis(z + slope * std::cos(t)) + std::cos(t) * x +
                        std::sin(t) * kAxis.cross(x));
  }
  return result;
}

films::BentWall tube() { return *wall_of(films::WallKind::Cylinder).bent(); }

TEST(BentWalls, TubesOfAnyLengthAreFilled) {
  for (const double length : {0.5, 20.0, 80.0}) {
    for (const bool turned : {false, true}) {
      std::vector<Points> loops = {ring(0.0, 20, 0.1), ring(length, 24, -0.1)};
      if (turned) {
        std::reverse(loops[1].begin(), loops[1].end());
      }
      const SurfaceMesh mesh = start::fill_bent_face(tube(), loops, 0.0, 0.4);
      expect_filled(mesh, 44, 2.0 * kPi * length, 0.03);
      for (const Vec3& p : mesh.points) {
        EXPECT_NEAR(films::distance_outside(tube(), p), 0.0, 1e-12);
      }
    }
  }
}

/// Of a face nearly around the axis the mean of its points says nothing about
/// its middle.
TEST(BentWalls, FacesNearlyAroundATubeAreFilled) {
  const Vec3 x = kAxis.unitOrthogonal();
  const auto at = [&](double angle, double z) {
    return Vec3(on_axis(z) + std::cos(angle) * x +
                std::sin(angle) * kAxis.cross(x));
  };
  for (const double wrap : {140.0, 250.0, 350.0}) {
    for (const double from : {0.0, 2.0, 4.0}) {
      Points loop;
      // More points at one end, which pull the mean there.
      const double angle = radians(wrap);
      for (int k = 0; k < 40; ++k) {
        loop.push_back(at(from + angle * k / 40.0, 0.0));
      }
      for (int k = 0; k < 60; ++k) {
        loop.push_back(at(from + angle, k / 60.0));
      }
      for (int k = 0; k < 40; ++k) {
        loop.push_back(at(from + angle * (40 - k) / 40.0, 1.0));
      }
      for (int k = 0; k < 10; ++k) {
        loop.push_back(at(from, 1.0 - k / 10.0));
      }
      expect_filled(start::fill_bent_face(tube(), {loop}, 0.0, 0.3),
                    loop.size(), angle, 0.02);
    }
  }
}

TEST(BentWalls, AFaceOfFewEdgesAboutAnApexHasAVertexThere) {
  const films::BentWall cone = *wall_of(films::WallKind::Cone).bent();
  Points loop;
  const Vec3 x = kAxis.unitOrthogonal();
  for (int k = 0; k < 5; ++k) {
    const double t = 2.0 * kPi * k / 5.0;
    loop.push_back(films::onto_wall(
        cone,
        on_axis(1.0) + 0.5 * (std::cos(t) * x + std::sin(t) * kAxis.cross(x))));
  }
  const SurfaceMesh mesh = start::fill_bent_face(cone, {loop}, 0.0, 10.0);
  ASSERT_EQ(mesh.points.size(), 6U);
  EXPECT_NEAR((mesh.points[5] - kOrigin).norm(), 0.0, 1e-12);
  EXPECT_EQ(mesh.facets.size(), 5U);
}

}  // namespace
}  // namespace meniscus::bent_walls_test
