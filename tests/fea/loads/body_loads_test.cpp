#include "fea/loads/body_loads.h"

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/parts.h"

namespace meniscus::body_loads_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kRounding = 1e-12;
constexpr double kSolver = 1e-9;  // of the solver's own tolerance 1e-10

element::Material warm_steel() {
  element::Material m = parts::steel();
  m.thermal_expansion.setConstant(1.2e-5);
  return m;
}

loads::LoadCase held(const std::string& surface) {
  loads::LoadCase load_case;
  load_case.name = "main";
  load_case.supports = {parts::hold(surface)};
  return load_case;
}

/// Rests against three planes, free to expand.
loads::LoadCase corner_held() {
  loads::LoadCase load_case;
  load_case.name = "warm";
  load_case.supports = {{"x0", true, false, false},
                        {"y0", false, true, false},
                        {"z0", false, false, true}};
  return load_case;
}

Vec3 total(const VectorX& f) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index d = 0; d < f.size(); d += 3) {
    sum += f.segment<3>(d);
  }
  return sum;
}

/// Largest distance of the solution from `exact(x)`, over the largest exact.
template <class Exact>
double error_of(const TetMesh& mesh, const VectorX& u, const Exact& exact) {
  double error = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 e = exact(mesh.nodes[i]);
    error = std::max(
        error, (u.segment<3>(static_cast<Eigen::Index>(3 * i)) - e).norm());
    size = std::max(size, e.norm());
  }
  return error / size;
}

class BodyLoads : public testing::TestWithParam<int> {
 protected:
  static TetMesh block(int n) {
    const TetMesh mesh = parts::distorted_brick({1.0, 2.0, 1.5}, n);
    return GetParam() == 1 ? mesh : shapes::straight_quadratic(mesh);
  }
};

TEST_P(BodyLoads, WeightIsMassTimesGravity) {
  TetMesh mesh = block(3);
  for (int e = 0; e < mesh.element_count(); e += 3) {
    mesh.element_region[e] = 1;
  }
  element::Material heavy = parts::steel();
  heavy.density *= 3.0;
  const std::vector<element::Material> materials = {parts::steel(), heavy};
  loads::LoadCase load_case = held("z0");
  load_case.gravity = {100.0, -20.0, -9810.0};
  const VectorX f = loads::nodal_forces(mesh, load_case, materials);
  const Vec3 exact = stress::mesh_mass(mesh, materials) * load_case.gravity;
  EXPECT_LE((total(f) - exact).norm(), kRounding * exact.norm());
}

TEST_P(BodyLoads, SpinPullsAtTheCentreOfMass) {
  const TetMesh mesh = block(3);
  loads::LoadCase load_case = held("z0");
  load_case.spin = loads::Spin{{0.5, -3.0, 7.0}, {0.0, 0.0, 2.0}, 40.0};
  const VectorX f = loads::nodal_forces(mesh, load_case, {parts::steel()});
  const Vec3 exact =
      parts::steel().density * 3.0 * 1600.0 * Vec3(0.5 - 0.5, 1.0 + 3.0, 0.0);
  EXPECT_LE((total(f) - exact).norm(), kRounding * exact.norm());
}

TEST_P(BodyLoads, UniformHeatingExpandsWithoutStress) {
  const TetMesh mesh = block(3);
  loads::LoadCase load_case = corner_held();
  load_case.temperature = loads::Temperature{.value = 120.0, .reference = 20.0};
  const std::vector<element::Material> materials = {warm_steel()};
  const elastic::ElasticModel model(mesh, materials, {load_case});
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  const double strain = 1.2e-3;
  EXPECT_LE(error_of(mesh, solution.displacements[0],
                     [&](const Vec3& x) { return Vec3(strain * x); }),
            kSolver);
  const stress::StressField stress =
      stress::recover_stress(mesh, materials, solution.displacements[0],
                             loads::temperature_change(mesh, load_case));
  const double held_back = materials[0].youngs_modulus * strain;
  EXPECT_LE(stress.max_von_mises, kSolver * held_back);
  EXPECT_LE(solution.report.strain_energy,
            kSolver * held_back * strain * stress::mesh_volume(mesh));
}

TEST_P(BodyLoads, HeatingBetweenWallsPresses) {
  const TetMesh mesh = block(3);
  element::Material material = warm_steel();
  material.poisson_ratio = 0.0;
  loads::LoadCase load_case = corner_held();
  load_case.supports.push_back({"x1", true, false, false});
  load_case.temperature = loads::Temperature{.value = -50.0, .reference = 50.0};
  const elastic::ElasticModel model(mesh, {material}, {load_case});
  const equations::ElasticSolution& solution = model.base_solution();
  ASSERT_FALSE(solution.failure) << solution.failure->message;
  const stress::StressField stress =
      stress::recover_stress(mesh, {material}, solution.displacements[0],
                             loads::temperature_change(mesh, load_case));
  const double exact = material.youngs_modulus * 1.2e-3;  // a pull: it cools
  for (const element::Stress& s : stress.nodal) {
    EXPECT_NEAR(s[0], exact, kSolver * exact);
    EXPECT_NEAR(s[1], 0.0, kSolver * exact);
  }
  const double energy = 0.5 * exact * 1.2e-3 * stress::mesh_volume(mesh);
  EXPECT_NEAR(solution.report.strain_energy, energy, kSolver * energy);
  Vec3 wall = Vec3::Zero();
  for (const int node : loads::surface_weights(mesh, "x1").nodes) {
    wall += solution.reactions[0].segment<3>(3L * node);
  }
  EXPECT_NEAR(wall.x(), exact * 3.0, kSolver * exact * 3.0);
}

TEST_P(BodyLoads, OrthotropicHeatingFollowsTheMaterialAxes) {
  const TetMesh mesh = block(2);
  element::Material material = parts::steel();
  material.orthotropic = element::Orthotropic{{9000.0, 700.0, 400.0},
                                              {0.3, 0.4, 0.4},
                                              {600.0, 500.0, 40.0},
                                              {Vec3::UnitZ(), Vec3::UnitX()}};
  material.thermal_expansion = {4e-6, 3e-5, 5e-5};
  loads::LoadCase load_case = corner_held();
  load_case.temperature = loads::Temperature{.value = 10.0};
  const elastic::ElasticModel model(
      mesh, {material}, {load_case},
      {.solver = equations::SolverKind::Cholesky});
  ASSERT_FALSE(model.base_solution().failure);
  const Vec3 strain(3e-4, 5e-4, 4e-5);
  EXPECT_LE(
      error_of(mesh, model.base_solution().displacements[0],
               [&](const Vec3& x) { return Vec3(strain.cwiseProduct(x)); }),
      kSolver);
}

INSTANTIATE_TEST_SUITE_P(Orders, BodyLoads, testing::Values(1, 2));

// Without Poisson's effect, u_z = -rho g (L z - z^2 / 2) / E: quadratic, so
// ten-node elements have it exactly.
TEST(Weight, ColumnSagsByItsQuadraticExactly) {
  const TetMesh mesh =
      shapes::straight_quadratic(parts::distorted_brick({1.0, 1.0, 4.0}, 3));
  element::Material material = parts::steel();
  material.poisson_ratio = 0.0;
  loads::LoadCase load_case = held("z0");
  load_case.gravity = {0.0, 0.0, -9810.0};
  const elastic::ElasticModel model(mesh, {material}, {load_case});
  ASSERT_FALSE(model.base_solution().failure);
  const double k = material.density * 9810.0 / material.youngs_modulus;
  EXPECT_LE(error_of(mesh, model.base_solution().displacements[0],
                     [&](const Vec3& x) {
                       return Vec3(0.0, 0.0,
                                   -k * (4.0 * x.z() - 0.5 * x.z() * x.z()));
                     }),
            kSolver);
}

// A temperature linear in place expands without stress: u_x = a (x y),
// u_y = a (y^2 - x^2 - z^2) / 2, u_z = a y z for T = y.
TEST(Heat, LinearTemperatureBendsWithoutStress) {
  const TetMesh mesh =
      shapes::straight_quadratic(parts::distorted_brick({1.0, 2.0, 1.5}, 3));
  const std::vector<element::Material> materials = {warm_steel()};
  loads::LoadCase load_case = held("x0");
  load_case.temperature =
      loads::Temperature{.field = [](const Vec3& x) { return 100.0 * x.y(); }};
  const double a = 100.0 * 1.2e-5;
  VectorX u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    u.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        a * Vec3(x.x() * x.y(),
                 0.5 * (x.y() * x.y() - x.x() * x.x() - x.z() * x.z()),
                 x.y() * x.z());
  }
  const VectorX change = loads::temperature_change(mesh, load_case);
  const stress::StressField stress =
      stress::recover_stress(mesh, materials, u, change);
  EXPECT_LE(stress.max_von_mises, 1e-10 * materials[0].youngs_modulus * a);
  const VectorX internal = solver::internal_forces(
      parts::table_of(mesh), mesh.nodes, element::elastic_laws(materials), u);
  const VectorX f = loads::nodal_forces(mesh, load_case, materials);
  EXPECT_LE((internal - f).norm(), 1e-11 * f.norm());
}

void expect_refused(const loads::LoadCase& load_case,
                    const std::vector<element::Material>& materials,
                    const char* part) {
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THAT([&] { loads::nodal_forces(mesh, load_case, materials); },
              testing::ThrowsMessage<InvalidInput>(HasSubstr(part)));
}

TEST(BodyLoadChecks, GravityNeedsDensityAndMaterial) {
  loads::LoadCase load_case = held("z0");
  load_case.gravity = {0.0, 0.0, -9810.0};
  element::Material weightless = parts::steel();
  weightless.density = 0.0;
  expect_refused(load_case, {weightless}, "material 'steel' of region 0");
  expect_refused(load_case, {}, "materials are given for 0");
  const TetMesh mesh = shapes::brick({1.0, 1.0, 1.0}, 1, 1, 1);
  EXPECT_THROW(elastic::ElasticModel(mesh, {weightless}, {load_case}),
               InvalidInput);
  EXPECT_THROW(elastic::ElasticModel(mesh, {}, {load_case}), InvalidInput);
  load_case.gravity.y() = NAN;
  expect_refused(load_case, {parts::steel()}, "gravity");
}

TEST(BodyLoadChecks, SpinNeedsAnAxis) {
  loads::LoadCase load_case = held("z0");
  load_case.spin = loads::Spin{.axis = Vec3::Zero(), .rate = 3.0};
  expect_refused(load_case, {parts::steel()}, "axis");
  load_case.spin = loads::Spin{.rate = INFINITY};
  expect_refused(load_case, {parts::steel()}, "rate");
}

TEST(BodyLoadChecks, TemperatureNeedsExpansionAndNumbers) {
  loads::LoadCase load_case = held("z0");
  load_case.temperature = loads::Temperature{.value = 100.0};
  expect_refused(load_case, {parts::steel()}, "thermal expansion");
  load_case.temperature->value = NAN;
  expect_refused(load_case, {warm_steel()}, "temperature");
  load_case.temperature->field = [](const Vec3& x) { return 1.0 / x.x(); };
  expect_refused(load_case, {warm_steel()}, "temperature at (0, 0, 0)");
}

}  // namespace
}  // namespace meniscus::body_loads_test
