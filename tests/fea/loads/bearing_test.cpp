/// Bearing loads: the cosine law, equilibrium, exact derivatives.
#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/loads/bearing_load.h"
#include "fea/loads/load_rates.h"
#include "fea/loads/loads.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::bearing_test {
namespace {

using testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-12;  // of sums of nodal forces
constexpr double kDerivative = 1e-7;
constexpr double kFaces = 1e-4;  // halves of a bore are cut into other faces

/// Half of a ring, 1 <= r <= 2 about the axis z, in two halves of the height:
/// x0 is the bore, its faces below the middle "low". Ten nodes, curved.
TetMesh half_ring(int n, double height) {
  TetMesh mesh = shapes::straight_quadratic(
      shapes::brick({1.0, kPi, height}, n, 4 * n, 4));
  for (Vec3& x : mesh.nodes) {
    const double r = 1.0 + x.x();
    x = Vec3(r * std::cos(x.y() - 0.5 * kPi), r * std::sin(x.y() - 0.5 * kPi),
             x.z());
  }
  mesh.labels.emplace_back("low");
  const int bore = mesh.label_of("x0");
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto ids = mesh.face(f);
    const double z = (mesh.nodes[ids[0]].z() + mesh.nodes[ids[1]].z() +
                      mesh.nodes[ids[2]].z()) /
                     3.0;
    if (mesh.face_label[f] == bore && z < 0.5 * height) {
      mesh.face_label[f] = mesh.label_of("low");
    }
  }
  return mesh;
}

Vec3 total(const VectorX& f) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < f.size(); i += 3) {
    sum += f.segment<3>(i);
  }
  return sum;
}

Vec3 moment_about(const TetMesh& mesh, const VectorX& f, const Vec3& point) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    sum += (mesh.nodes[i] - point).cross(f.segment<3>(3L * i));
  }
  return sum;
}

VectorX forces(const TetMesh& mesh, const loads::BearingLoad& load) {
  loads::LoadCase load_case{.name = "bearing"};
  load_case.bearings = {load};
  return loads::nodal_forces(mesh, load_case);
}

// p = p0 cos(phi), p0 = 2 F / (pi r h), to the order of the curved faces.
TEST(Bearing, IsTheCosineOnARoundBore) {
  std::vector<double> errors;
  for (const int n : {1, 2, 4}) {
    const TetMesh mesh = half_ring(n, 0.8);
    const Vec3 force(30.0, 0.0, 0.0);
    const loads::BearingLoad load{.surfaces = {"x0", "low"}, .force = force};
    const loads::BearingPressure pressure(mesh, load);
    EXPECT_NEAR(std::abs(pressure.axis().z()), 1.0, 1e-9);
    const double p0 = 2.0 * 30.0 / (kPi * 0.8);
    double error = 0.0;
    for (const char* surface : {"x0", "low"}) {
      element::over_face_points(
          mesh, mesh.label_of(surface), element::FaceRule::Seven,
          [&](int, const element::FacePoint& point) {
            const double p = pressure.pressed(point) / point.normal.norm();
            const double cos = point.position.head<2>().normalized().x();
            error = std::max(error, std::abs(p - p0 * cos) / p0);
          });
    }
    errors.push_back(error);
    const VectorX f = forces(mesh, load);
    EXPECT_LE((total(f) - force).norm(), kRounding * 30.0);
  }
  EXPECT_LE(errors[2], 3e-3);
  EXPECT_GE(errors[0] / errors[1], 3.5);  // normals of quadratic faces: order 2
  EXPECT_GE(errors[1] / errors[2], 3.5);
}

TEST(Bearing, HasTheForceExactlyInAnyDirection) {
  const TetMesh mesh = half_ring(2, 0.8);
  for (const Vec3& force :
       {Vec3(3.0, 0.5, 0.0), Vec3(1.0, -2.0, 0.3), Vec3(0.7, 1.5, -4.0)}) {
    const VectorX f = forces(mesh, {.surfaces = {"x0", "low"}, .force = force});
    EXPECT_LE((total(f) - force).norm(), kRounding * force.norm());
  }
}

// A pin through two lugs, pulled off their middle: as levers say.
TEST(Bearing, SurfacesShareItByTheBalanceAboutThePoint) {
  const TetMesh mesh = half_ring(2, 0.8);
  const Vec3 force(30.0, 4.0, 0.0);
  const Vec3 point(0.0, 0.0, 0.25);
  const loads::BearingLoad load{
      .surfaces = {"x0", "low"}, .force = force, .point = point};
  const VectorX f = forces(mesh, load);
  EXPECT_LE((total(f) - force).norm(), kRounding * 30.0);
  Vec3 moment = moment_about(mesh, f, point);
  EXPECT_LE(moment.head<2>().norm(), 1e-10);
  EXPECT_LE(std::abs(moment.z()), 0.02 * 30.0);
  // Without a point each has the pressure of its own height.
  const VectorX even =
      forces(mesh, {.surfaces = {"x0", "low"}, .force = force});
  moment = moment_about(mesh, even, {0.0, 0.0, 0.4});
  EXPECT_LE(moment.head<2>().norm(), kFaces * 30.0);
}

TEST(Bearing, WhatCannotBePressedIsRefused) {
  const TetMesh mesh = half_ring(2, 0.8);
  const auto message = [&](const loads::BearingLoad& load) -> std::string {
    try {
      forces(mesh, load);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  // The bore is open at x < 0.
  EXPECT_THAT(message({.surfaces = {"x0", "low"}, .force = {-1.0, 0.0, 0.0}}),
              HasSubstr("no part of it faces that way"));
  EXPECT_THAT(message({.surfaces = "z1", .force = {1.0, 0.0, 0.0}}),
              HasSubstr("no bore that shows its axis"));
  EXPECT_THAT(message({.surfaces = {"x0", "low"}}), HasSubstr("force of 0"));
  EXPECT_THAT(message({.surfaces = {"x0", "low"},
                       .force = {1.0, 0.0, 0.0},
                       .point = Vec3(0.0, 0.3, 0.4)}),
              HasSubstr("put it on the axis"));
  EXPECT_THAT(message({.surfaces = {"x0", "low"},
                       .force = {1.0, 0.0, 0.0},
                       .axis = Vec3(0.0, 0.0, 0.0)}),
              HasSubstr("axis without length"));
}

struct Kind {
  const char* name;
  loads::BearingLoad load;
};

std::vector<Kind> kinds() {
  const Vec3 force(3.0, 0.8, -0.7);
  return {{"Fitted", {.surfaces = {"x0", "low"}, .force = force}},
          {"Balanced",
           {.surfaces = {"x0", "low"},
            .force = force,
            .point = Vec3(0.01, -0.01, 0.3)}},
          {"OfAnAxis",
           {.surfaces = {"x0", "low"},
            .force = force,
            .point = Vec3(0.0, 0.0, 0.5),
            .axis = Vec3(0.1, -0.05, 2.0)}}};
}

// Steps are short: where a point of the rule is just where pressure ends its
// slope has a kink.
TEST(Bearing, DerivativesByPlacesAndNumbers) {
  const TetMesh mesh = half_ring(2, 0.8);
  const VectorX v = derivatives::wave(mesh, 0.8);
  const VectorX dx = derivatives::wave(mesh, 0.4);
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    Points gradient(mesh.nodes.size(), Vec3::Zero());
    const loads::BearingGradient by =
        loads::bearing_gradient(mesh, kind.load, v, &gradient);
    EXPECT_NEAR(by.value, v.dot(forces(mesh, kind.load)),
                kRounding * std::abs(by.value));
    const auto difference = [&](const auto& value) {
      constexpr double kStep = 1e-5;
      return (value(kStep) - value(-kStep)) / (2.0 * kStep);
    };
    const double exact = flat(gradient).dot(dx);
    EXPECT_NEAR(
        difference([&](double t) {
          return v.dot(forces(derivatives::moved(mesh, dx, t), kind.load));
        }),
        exact, kDerivative * flat(gradient).cwiseProduct(dx).lpNorm<1>());
    loads::LoadCase load_case{.name = "bearing"};
    load_case.bearings = {kind.load};
    loads::LoadCase rates{.name = "bearing"};
    rates.bearings = {{.force = {0.4, -1.0, 0.3},
                       .point = Vec3(0.02, 0.01, -0.3),
                       .axis = Vec3(0.2, 0.3, -0.4)}};
    const double rate = loads::load_rate(
        loads::load_gradient(mesh, {parts::steel()}, load_case, v), rates);
    EXPECT_NEAR(difference([&](double t) {
                  loads::BearingLoad load = kind.load;
                  load.force += t * rates.bearings[0].force;
                  if (load.point) {
                    *load.point += t * *rates.bearings[0].point;
                  }
                  if (load.axis) {
                    *load.axis += t * *rates.bearings[0].axis;
                  }
                  return v.dot(forces(mesh, load));
                }),
                rate, kDerivative * (std::abs(rate) + std::abs(by.value)));
  }
}

// A point of the rule that begins to be pressed bends the curve, no more: the
// function has no jump over a full turn of the force, and its slope hardly any.
TEST(Bearing, TurnsWithItsForceWithoutJumps) {
  const TetMesh mesh = half_ring(2, 0.8);
  const VectorX v = derivatives::wave(mesh, 0.8);
  const auto at = [&](double angle) -> loads::BearingLoad {
    return {.surfaces = {"x0", "low"},
            .force = {std::cos(angle), std::sin(angle), 0.0},
            .axis = Vec3::UnitZ()};
  };
  constexpr int kSteps = 400;
  const double step = 1.0 / kSteps;  // of 1 rad
  double value = 0.0;
  double slope = 0.0;
  double curve = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = k * step - 0.5;
    const loads::BearingGradient by =
        loads::bearing_gradient(mesh, at(angle), v, nullptr);
    const double next =
        by.by_force.dot(Vec3(-std::sin(angle), std::cos(angle), 0.0));
    if (k > 0) {
      EXPECT_NEAR(by.value - value, 0.5 * step * (slope + next),
                  0.05 * step * std::abs(by.value));
      curve = std::max(curve, std::abs(next - slope));
    }
    value = by.value;
    slope = next;
  }
  EXPECT_LE(curve, 0.2 * std::abs(value));
}

}  // namespace
}  // namespace meniscus::bearing_test
