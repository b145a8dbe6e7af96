/// NAFEMS' linear elastic benchmarks LE1, LE10 and LE11 (The standard NAFEMS
/// benchmarks, 1990). Lengths in m, stresses in MPa.
#include <array>
#include <cmath>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fea/elastic/elasticity.h"
#include "fea/loads/body_loads.h"
#include "tests/support/mapped_shapes.h"
#include "tests/support/shapes.h"

namespace meniscus::nafems_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

element::Material material() {
  element::Material m{
      .name = "NAFEMS", .youngs_modulus = 210e3, .poisson_ratio = 0.3};
  m.thermal_expansion.setConstant(2.3e-4);
  return m;
}

loads::Support fix(const char* surface, bool x, bool y, bool z) {
  return {surface, x, y, z};
}

int node_at(const TetMesh& mesh, const Vec3& x) {
  int best = 0;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    if ((mesh.nodes[i] - x).norm() < (mesh.nodes[best] - x).norm()) {
      best = i;
    }
  }
  return best;
}

/// The quarter of a plate between two ellipses: x0 inside, x1 outside, y0 the
/// plane y = 0, y1 the plane x = 0.
TetMesh elliptic_plate(double height, int n, int layers) {
  return shapes::mapped(shapes::straight_quadratic(shapes::brick(
                            {1.0, 0.5 * kPi, height}, n, 2 * n, layers)),
                        [](const Vec3& p) -> Vec3 {
                          // Cells narrow towards the inner edge, where D is.
                          const double s = std::pow(p.x(), 1.4);
                          return {(2.0 + 1.25 * s) * std::cos(p.y()),
                                  (1.0 + 1.75 * s) * std::sin(p.y()), p.z()};
                        });
}

double stress_at(const TetMesh& mesh, const loads::LoadCase& load,
                 const Vec3& place, int component) {
  const elastic::ElasticModel model(mesh, {material()}, {load});
  EXPECT_FALSE(model.base_solution().failure);
  return stress::recover_stress(mesh, {material()},
                                model.base_solution().displacements[0],
                                loads::temperature_change(mesh, load))
      .nodal[node_at(mesh, place)][component];
}

/// Prints a refinement; the last value must be within `tolerance` of `target`
/// and of the value before.
void expect_target(const char* name, const std::vector<double>& values,
                   double target, double tolerance) {
  for (const double value : values) {
    std::cout << fmt::format("{}: {:.3f} MPa, target {} ({:+.2f} %)\n", name,
                             value, target, 100.0 * (value / target - 1.0));
  }
  const double last = values.back();
  EXPECT_NEAR(last, target, tolerance * std::abs(target)) << name;
  EXPECT_NEAR(last, values[values.size() - 2], tolerance * std::abs(target));
}

TEST(Nafems, Le1EllipticMembrane) {
  std::vector<double> values;
  for (const int n : {4, 8, 16}) {
    // Half the thickness: the middle plane is one of symmetry.
    const TetMesh mesh = elliptic_plate(0.05, n, 1);
    loads::LoadCase load{.name = "LE1",
                         .supports = {fix("y0", false, true, false),
                                      fix("y1", true, false, false),
                                      fix("z0", false, false, true)}};
    load.pressures = {{.surface = "x1", .pressure = -10.0}};
    values.push_back(stress_at(mesh, load, {2.0, 0.0, 0.0}, 1));
  }
  expect_target("LE1 s_yy(D)", values, 92.7, 0.01);
}

/// Names the nodes of the outer edge at half the height, as a surface without
/// area: a support needs no more.
void name_middle_line(TetMesh& mesh, double height) {
  const int label = static_cast<int>(mesh.labels.size());
  mesh.labels.emplace_back("line");
  constexpr double kOn = 1e-9;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    const Vec3& x = mesh.nodes[i];
    if (std::abs(std::hypot(x.x() / 3.25, x.y() / 2.75) - 1.0) < kOn &&
        std::abs(x.z() - 0.5 * height) < kOn) {
      mesh.faces.insert(mesh.faces.end(), 6, i);
      mesh.face_label.push_back(label);
      mesh.face_element.push_back(0);
      if (!mesh.face_front.empty()) {
        mesh.face_front.push_back(-1);
      }
    }
  }
}

TEST(Nafems, Le10ThickPlate) {
  constexpr double kHeight = 0.6;
  std::vector<double> values;
  for (const auto& [n, layers] : {std::pair{4, 2}, {8, 4}, {12, 6}}) {
    TetMesh mesh = elliptic_plate(kHeight, n, layers);
    name_middle_line(mesh, kHeight);
    loads::LoadCase load{.name = "LE10",
                         .supports = {fix("y0", false, true, false),
                                      fix("y1", true, false, false),
                                      fix("x1", true, true, false),
                                      fix("line", false, false, true)}};
    load.pressures = {{.surface = "z1", .pressure = 1.0}};
    values.push_back(stress_at(mesh, load, {2.0, 0.0, kHeight}, 1));
  }
  expect_target("LE10 s_yy(D)", values, -5.38, 0.02);
}

/// Inner and outer (radius, height) at s from 0 (bottom) to 3 (top): sphere,
/// taper, cylinder.
std::array<std::array<double, 2>, 2> meridian(double s) {
  const double knee = std::sin(0.25 * kPi);
  const double outer_knee = std::sqrt(1.4 * 1.4 - knee * knee);
  if (s <= 1.0) {
    const double inner = 0.25 * kPi * s;
    const double outer = std::asin(knee / 1.4) * s;
    return {{{std::cos(inner), std::sin(inner)},
             {1.4 * std::cos(outer), 1.4 * std::sin(outer)}}};
  }
  if (s <= 2.0) {
    const double z = knee + 0.69 * (s - 1.0);
    return {{{knee, z}, {outer_knee + (1.0 - outer_knee) * (s - 1.0), z}}};
  }
  const double z = knee + 0.69 + 0.4 * (s - 2.0);
  return {{{knee, z}, {1.0, z}}};
}

TEST(Nafems, Le11CylinderTaperSphereUnderTemperature) {
  std::vector<double> values;
  for (const int n : {1, 2, 4}) {
    const TetMesh mesh = shapes::mapped(
        shapes::straight_quadratic(
            shapes::brick({1.0, 0.5 * kPi, 3.0}, 2 * n, 4 * n, 6 * n)),
        [](const Vec3& p) -> Vec3 {
          const auto [inner, outer] = meridian(p.z());
          const double r = inner[0] + (outer[0] - inner[0]) * p.x();
          return {r * std::cos(p.y()), r * std::sin(p.y()),
                  inner[1] + (outer[1] - inner[1]) * p.x()};
        });
    loads::LoadCase load{.name = "LE11",
                         .supports = {fix("y0", false, true, false),
                                      fix("y1", true, false, false),
                                      fix("z0", false, false, true),
                                      fix("z1", false, false, true)}};
    load.temperature = loads::Temperature{.field = [](const Vec3& x) {
      return std::hypot(x.x(), x.y()) + x.z();
    }};
    values.push_back(stress_at(mesh, load, {1.0, 0.0, 0.0}, 2));
  }
  expect_target("LE11 s_zz(A)", values, -105.0, 0.02);
}

}  // namespace
}  // namespace meniscus::nafems_test
