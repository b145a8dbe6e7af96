/// Parts, materials and load cases that the gradient tests share.
#pragma once

#include <vector>

#include "tests/support/parts.h"

namespace meniscus::gradient_parts {

/// Distorted block of two regions; ten-node elements are curved.
inline TetMesh block(int order, int cells = 3) {
  TetMesh mesh = parts::distorted_brick({1.5, 1.0, 1.2}, cells);
  for (int e = 0; e < mesh.element_count(); e += 3) {
    mesh.element_region[e] = 1;
  }
  if (order == 2) {
    mesh = shapes::straight_quadratic(mesh);
    for (Vec3& x : mesh.nodes) {
      x += 0.05 * Vec3(std::sin(2.0 * x.y()), std::sin(1.5 * x.z() + x.x()),
                       std::cos(2.0 * x.x()));
    }
  }
  return mesh;
}

/// An isotropic and an orthotropic one, both of which expand.
inline std::vector<element::Material> materials() {
  element::Material metal{"metal", 70.0, 0.33, 2.7, {}};
  metal.thermal_expansion.setConstant(2e-3);
  element::Material ply{"ply", 0.0, 0.0, 1.6, {}};
  ply.orthotropic =
      element::Orthotropic{.youngs_moduli = {120.0, 9.0, 11.0},
                           .poisson_ratios = {0.3, 0.25, 0.4},
                           .shear_moduli = {5.0, 4.0, 3.0},
                           .axes = {{1.0, 0.4, 0.2}, {0.0, 1.0, 0.5}}};
  ply.thermal_expansion = {-1e-4, 3e-3, 2.5e-3};
  return {metal, ply};
}

inline loads::LoadCase held(const char* name) {
  loads::LoadCase load_case;
  load_case.name = name;
  load_case.supports = {parts::hold("x0")};
  return load_case;
}

inline loads::LoadCase warm() {
  loads::LoadCase load_case = held("warm");
  load_case.temperature = loads::Temperature{
      .field = [](const Vec3& x) { return 20.0 + 5.0 * x.x() * x.y(); },
      .reference = 15.0,
      .slope = [](const Vec3& x) { return Vec3(5.0 * x.y(), 5.0 * x.x(), 0); }};
  return load_case;
}

inline loads::LoadCase with_fields() {
  loads::LoadCase load_case = held("fields");
  load_case.pressures = {
      {.surface = "z1",
       .field = [](const Vec3& x) { return 1.0 + x.x() * x.x() - x.y(); },
       .slope = [](const Vec3& x) { return Vec3(2.0 * x.x(), -1.0, 0.0); }}};
  load_case.tractions = {
      {.surface = "y1",
       .field = [](const Vec3& x) { return Vec3(x.z(), x.x() * x.y(), 0.3); },
       .slope =
           [](const Vec3& x) {
             Mat3 slope;
             slope << 0.0, 0.0, 1.0, x.y(), x.x(), 0.0, 0.0, 0.0, 0.0;
             return slope;
           }}};
  return load_case;
}

/// A load case of each kind of load.
inline std::vector<loads::LoadCase> load_cases() {
  std::vector<loads::LoadCase> all;
  all.push_back(held("force"));
  all.back().forces = {{"x1", {1.0, 2.0, -3.0}}, {"y1", {0.5, 0.0, 0.2}}};
  all.push_back(held("pressure"));
  all.back().pressures = {{"x1", 2.0}, {"z1", -1.5}};
  all.back().tractions = {{"y0", {0.3, 0.2, -0.7}}};
  all.push_back(with_fields());
  all.push_back(held("weight"));
  all.back().gravity = {0.3, -0.2, -9.8};
  all.back().spin = loads::Spin{{0.1, -0.4, 0.2}, {0.2, 0.3, 1.0}, 2.0};
  all.push_back(held("remote"));
  all.back().remote_loads = {{.surfaces = "x1",
                              .point = {3.0, 0.7, -0.4},
                              .force = {0.5, -1.0, 2.0},
                              .moment = {0.4, 0.3, -0.6}}};
  all.push_back(held("together"));
  all.back().forces = {{{"x1", "z1"}, {1.0, 2.0, -3.0}}};
  all.back().remote_loads = {{.surfaces = {"y0", "y1"},
                              .point = {2.0, 0.7, -0.4},
                              .force = {0.5, -1.0, 2.0},
                              .moment = {0.4, 0.3, -0.6}}};
  all.push_back(warm());
  return all;
}

}  // namespace meniscus::gradient_parts
