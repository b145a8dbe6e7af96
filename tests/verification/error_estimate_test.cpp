/// Estimated errors against true ones on problems with exact solutions.
#include "fea/stress/error_estimate.h"

#include <array>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/exact_elasticity.h"
#include "tests/support/mapped_shapes.h"
#include "tests/support/parts.h"

namespace meniscus::error_estimate_test {
namespace {

// The demands: estimate over true error, in energy and per response.
constexpr double kLeast = 0.8;
constexpr double kMost = 1.3;
constexpr double kResponseFactor = 2.0;

struct Problem {
  const char* name;
  exact::Field field;
  TetMesh (*mesh)(int n);
  std::vector<loads::Support> supports;
  std::vector<std::string> loaded;  // surfaces with the field's tractions
  exact::BodyForce body;
  std::string response_surface;
  Vec3 direction;
};

loads::Support fix_x(const char* s) { return {s, true, false, false}; }
loads::Support fix_y(const char* s) { return {s, false, true, false}; }
loads::Support fix_z(const char* s) { return {s, false, false, true}; }

/// Each component vanishes on its plane through the origin.
exact::Field manufactured() {
  return {parts::steel(), [](const exact::DualVec& x) -> exact::DualVec {
            const exact::Dual wave = 1e-3 * exp(0.5 * x[2] - 0.3 * x[0]);
            return {wave * sin(2.0 * x[0]) * cos(1.5 * x[1]),
                    wave * -0.7 * sin(1.5 * x[1]) * cos(x[0]),
                    wave * 0.4 * sin(x[2]) * cos(2.0 * x[1])};
          }};
}

std::vector<Problem> problems() {
  const element::Material steel = parts::steel();
  return {{"thick sphere",
           exact::thick_sphere(steel, 1.0, 2.0, 100.0),
           [](int n) { return shapes::octant_shell(1.0, 2.0, 2 * n, n); },
           {fix_x("x0"), fix_y("y0"), fix_z("z0")},
           {"inner", "outer"},
           exact::BodyForce::None,
           "outer",
           Vec3::Ones()},
          {"hole in a plate",
           exact::hole_in_plate(steel, 1.0, 100.0),
           [](int n) {
             return shapes::quarter_ring(1.0, 4.0, 1.0, 2 * n, 2 * n, n);
           },
           {fix_x("x0"), fix_y("y0"), fix_z("z0"), fix_z("z1")},
           {"inner", "outer"},
           exact::BodyForce::None,
           "inner",
           Vec3::UnitX()},
          {"spherical cavity",
           exact::spherical_cavity(steel, 100.0),
           [](int n) { return shapes::octant_shell(1.0, 4.0, 2 * n, 2 * n); },
           {fix_x("x0"), fix_y("y0"), fix_z("z0")},
           {"inner", "outer"},
           exact::BodyForce::None,
           "outer",
           Vec3::UnitZ()},
          {"manufactured",
           manufactured(),
           [](int n) {
             return shapes::straight_quadratic(
                 parts::distorted_brick({1.0, 1.0, 1.0}, 2 * n));
           },
           {fix_x("x0"), fix_y("y0"), fix_z("z0")},
           {"x0", "x1", "y0", "y1", "z0", "z1"},
           exact::BodyForce::Included,
           "x1",
           Vec3::UnitZ()}};
}

class Estimate : public testing::TestWithParam<int> {};

TEST_P(Estimate, IsCloseToTheTrueError) {
  const Problem p = problems()[GetParam()];
  const element::Material material = p.field.material();
  double last = 0.0;
  for (const int n : {4, 8}) {
    const TetMesh mesh = p.mesh(n);
    loads::LoadCase primal{.name = "load", .supports = p.supports};
    primal.nodal = exact::loads(mesh, p.field, p.loaded, p.body);
    loads::LoadCase dual{.name = "dual", .supports = p.supports};
    dual.forces = {{p.response_surface, p.direction.normalized()}};
    const elastic::ElasticModel model(mesh, {material}, {primal, dual});
    ASSERT_FALSE(model.base_solution().failure);
    const VectorX& u = model.base_solution().displacements[0];
    const VectorX& z = model.base_solution().displacements[1];
    const stress::RecoveredStress su = stress::recover_by_patches(
        mesh, element::point_stress(mesh, {material}, u));
    const stress::RecoveredStress sz = stress::recover_by_patches(
        mesh, element::point_stress(mesh, {material}, z));
    const stress::EnergyError energy =
        stress::estimate_error(mesh, {material}, {u, su, {}});
    const exact::Norms norms = exact::error_norms(mesh, p.field, u);
    const double ratio = energy.error / norms.energy;
    const stress::ResponseError response =
        stress::response_error(mesh, {material}, {u, su, {}}, {z, sz, {}});
    const double value =
        loads::mean_displacement(mesh, p.response_surface, p.direction, u);
    const double error = exact::mean_displacement(
                             mesh, p.field, p.response_surface, p.direction) -
                         value;
    std::cout << fmt::format(
        "{} n {}: {} elements; energy error {:.3e} of {:.3e}, effectivity "
        "{:.3f}, true rate {:.2f}; response {:.6e}, error {:.2e}, estimate "
        "{:.2e} (ratio {:.2f}), bound {:.2e}\n",
        p.name, n, mesh.element_count(), norms.energy, norms.energy_exact,
        ratio, last > 0.0 ? std::log2(last / norms.energy) : 0.0, value, error,
        response.value, response.value / error, response.bound);
    last = norms.energy;
    EXPECT_GE(response.bound, std::abs(response.value));
    if (n == 8) {
      EXPECT_GT(ratio, kLeast);
      EXPECT_LT(ratio, kMost);
      EXPECT_GT(response.value / error, 1.0 / kResponseFactor);
      EXPECT_LT(response.value / error, kResponseFactor);
    }
  }
}

/// The corners of a ten-node mesh with their four-node elements.
TetMesh four_node(const TetMesh& mesh) {
  TetMesh linear = mesh;
  linear.order = 1;
  linear.nodes.resize(mesh.corner_count);
  linear.elements.clear();
  linear.faces.clear();
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto corners = mesh.element(e).first<4>();
    linear.elements.insert(linear.elements.end(), corners.begin(),
                           corners.end());
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto corners = mesh.face(f).first<3>();
    linear.faces.insert(linear.faces.end(), corners.begin(), corners.end());
  }
  return linear;
}

TEST(EstimateOfFourNodeElements, IsCloseToTheTrueError) {
  for (const int which : {1, 2, 3}) {
    const Problem p = problems()[which];
    const element::Material material = p.field.material();
    const TetMesh mesh = four_node(p.mesh(8));
    loads::LoadCase load{.name = "load", .supports = p.supports};
    load.nodal = exact::loads(mesh, p.field, p.loaded, p.body);
    const elastic::ElasticModel model(mesh, {material}, {load});
    ASSERT_FALSE(model.base_solution().failure);
    const VectorX& u = model.base_solution().displacements[0];
    const stress::EnergyError energy = stress::estimate_error(
        mesh, {material},
        {u,
         stress::recover_by_patches(mesh,
                                    element::point_stress(mesh, {material}, u)),
         {}});
    const exact::Norms norms = exact::error_norms(mesh, p.field, u);
    std::cout << fmt::format(
        "{}, four-node: {} elements, energy error {:.3e} of {:.3e}, "
        "effectivity {:.3f}\n",
        p.name, mesh.element_count(), norms.energy, norms.energy_exact,
        energy.error / norms.energy);
    EXPECT_GT(energy.error / norms.energy, kLeast);
    EXPECT_LT(energy.error / norms.energy, kMost);
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, Estimate, testing::Range(0, 4));

}  // namespace
}  // namespace meniscus::error_estimate_test
