#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/elastic/elastic_gradient.h"
#include "fea/functionals/energy_functionals.h"
#include "fea/functionals/place_functionals.h"
#include "fea/functionals/stress_functionals.h"
#include "fea/loads/load_rates.h"
#include "fea/loads/loads.h"
#include "fea/loads/material_rates.h"
#include "tests/support/derivatives.h"
#include "tests/support/gradient_parts.h"

namespace meniscus::rates_test {
namespace {

using derivatives::expect_derivative;
using derivatives::wave;

class Rates : public testing::TestWithParam<int> {
 protected:
  void expect_load_rate(const std::function<loads::LoadCase(double)>& at,
                        const loads::LoadCase& rates) const {
    const double exact = loads::load_rate(
        loads::load_gradient(mesh_, materials_, at(0.0), v_), rates);
    expect_derivative(
        {.exact = exact, .scale = std::abs(exact), .step = 1e-2},
        [&](double t) {
          return v_.dot(loads::nodal_forces(mesh_, at(t), materials_));
        });
  }

  TetMesh mesh_ = gradient_parts::block(GetParam());
  std::vector<element::Material> materials_ = gradient_parts::materials();
  VectorX v_ = wave(mesh_, 0.8);
};

TEST_P(Rates, OfNumbersOfLoads) {
  loads::LoadCase rates;
  rates.forces = {{"x1", {0.3, -1.0, 2.0}}};
  rates.pressures = {{"z1", 0.7}};
  rates.tractions = {{"y1", {0.2, 0.4, -0.5}}};
  rates.remote_loads = {
      {"x1", {0.3, 0.2, -0.5}, {1.0, -0.2, 0.4}, {0.1, 0.5, 0.2}}};
  rates.gravity = {0.5, 0.2, 1.0};
  rates.spin = loads::Spin{{0.3, 0.1, -0.2}, {0.1, -0.2, 0.3}, 0.7};
  rates.temperature = loads::Temperature{.value = 3.0, .reference = 1.0};
  rates.nodal = 0.3 * wave(mesh_, 0.1);
  expect_load_rate(
      [&](double t) {
        loads::LoadCase at = gradient_parts::held("all");
        at.forces = {{"x1", Vec3(1.0, 2.0, 3.0) + t * rates.forces[0].total}};
        at.pressures = {{"z1", 2.0 + t * 0.7}};
        at.tractions = {
            {"y1", Vec3(0.1, 0.0, 0.3) + t * rates.tractions[0].traction}};
        const loads::RemoteLoad& r = rates.remote_loads[0];
        at.remote_loads = {{"x1", Vec3(3.0, 1.0, 0.5) + t * r.point,
                            Vec3(0.2, 0.7, -0.4) + t * r.force,
                            Vec3(0.5, 0.1, 0.6) + t * r.moment}};
        at.gravity = Vec3(0.0, 0.3, -9.8) + t * rates.gravity;
        at.spin = loads::Spin{Vec3(0.4, -0.3, 0.2) + t * rates.spin->point,
                              Vec3(0.2, 0.1, 1.4) + t * rates.spin->axis,
                              1.5 + t * rates.spin->rate};
        at.temperature = loads::Temperature{.value = 40.0 + t * 3.0,
                                            .reference = 20.0 + t * 1.0};
        at.nodal = wave(mesh_, 0.6) + t * rates.nodal;
        return at;
      },
      rates);
}

TEST_P(Rates, OfLoadsOfSeveralSurfaces) {
  loads::LoadCase rates;
  rates.forces = {{{"x1", "z1"}, {0.3, -1.0, 2.0}}};
  rates.remote_loads = {
      {{"y0", "y1"}, {0.3, 0.2, -0.5}, {1.0, -0.2, 0.4}, {0.1, 0.5, 0.2}}};
  expect_load_rate(
      [&](double t) {
        loads::LoadCase at = gradient_parts::held("together");
        at.forces = {
            {{"x1", "z1"}, Vec3(1.0, 2.0, 3.0) + t * rates.forces[0].total}};
        const loads::RemoteLoad& r = rates.remote_loads[0];
        at.remote_loads = {{{"y0", "y1"},
                            Vec3(3.0, 1.0, 0.5) + t * r.point,
                            Vec3(0.2, 0.7, -0.4) + t * r.force,
                            Vec3(0.5, 0.1, 0.6) + t * r.moment}};
        return at;
      },
      rates);
}

TEST_P(Rates, OfFields) {
  loads::LoadCase rates;
  rates.pressures = {
      {.surface = "z1", .field = [](const Vec3& x) { return x.x(); }},
      {"y0", 0.4}};
  rates.tractions = {{.surface = "y1", .field = [](const Vec3& x) {
                        return Vec3(x.y(), 1.0, x.x() * x.z());
                      }}};
  rates.temperature = loads::Temperature{
      .field = [](const Vec3& x) { return x.z() * x.y(); }, .reference = 0.5};
  const auto at = [&](double t) {
    loads::LoadCase result = gradient_parts::held("fields");
    result.pressures = {
        {.surface = "z1",
         .field =
             [t](const Vec3& x) { return 1.0 + x.y() * x.y() + t * x.x(); }},
        {.surface = "y0",
         .field = [t](const Vec3& x) { return x.x() + t * 0.4; }}};
    result.tractions = {{.surface = "y1", .field = [t](const Vec3& x) {
                           return Vec3(Vec3(x.z(), 0.2, 0.3) +
                                       t * Vec3(x.y(), 1.0, x.x() * x.z()));
                         }}};
    result.temperature = loads::Temperature{
        .field =
            [t](const Vec3& x) { return 30.0 + x.x() + t * x.z() * x.y(); },
        .reference = 10.0 + t * 0.5};
    return result;
  };
  expect_load_rate(at, rates);
}

/// What stresses and energy know of a temperature at fixed displacement.
TEST_P(Rates, OfTemperaturesInFunctionals) {
  const VectorX u = 0.1 * wave(mesh_, 1.7);
  const std::vector<char> all;
  const auto at = [](double t) {
    loads::LoadCase load_case = gradient_parts::warm();
    load_case.temperature->field = [t](const Vec3& x) {
      return 20.0 + 5.0 * x.x() * x.y() + t * x.z();
    };
    load_case.temperature->reference += 0.3 * t;
    return load_case;
  };
  loads::LoadCase rates;
  rates.temperature = loads::Temperature{
      .field = [](const Vec3& x) { return x.z(); }, .reference = 0.3};
  const auto expect = [&](const auto& functional) {
    loads::LoadGradient gradient;
    loads::add_temperature_gradient(
        mesh_, at(0.0), functional(at(0.0)).by_temperature, gradient);
    const double exact = loads::load_rate(gradient, rates);
    expect_derivative({.exact = exact, .scale = std::abs(exact), .step = 1e-2},
                      [&](double t) { return functional(at(t)).value; });
  };
  expect([&](const loads::LoadCase& load_case) {
    return functionals::strain_energy_functional(mesh_, materials_, load_case,
                                                 u);
  });
  expect([&](const loads::LoadCase& load_case) {
    return functionals::von_mises_norm_functional(
        {mesh_, materials_, load_case, u, all}, 6.0);
  });
}

TEST_P(Rates, OfMaterials) {
  loads::LoadCase load_case = gradient_parts::warm();
  load_case.gravity = {1.0, 2.0, -9.8};
  load_case.spin = loads::Spin{{0.1, -0.4, 0.2}, {0.2, 0.3, 1.0}, 2.0};
  const VectorX u = 0.1 * wave(mesh_, 1.7);
  const loads::MaterialGradient by =
      loads::material_gradient(mesh_, materials_, load_case, u, v_);
  const auto expect = [&](double exact, const auto& change) {
    expect_derivative(
        {.exact = exact, .scale = std::abs(exact), .step = 1e-2},
        [&](double t) {
          std::vector<element::Material> at = materials_;
          change(t, at);
          const solver::ElementTable table = parts::table_of(mesh_);
          return v_.dot(loads::nodal_forces(mesh_, load_case, at) -
                        solver::internal_forces(table, mesh_.nodes,
                                                element::elastic_laws(at), u));
        });
  };
  expect(by.youngs_modulus[0],
         [](double t, std::vector<element::Material>& at) {
           at[0].youngs_modulus += t;
         });
  expect(by.poisson_ratio[0], [](double t, std::vector<element::Material>& at) {
    at[0].poisson_ratio += t;
  });
  expect(by.youngs_modulus[1],
         [](double t, std::vector<element::Material>& at) {
           at[1].orthotropic->youngs_moduli *= 1.0 + t;
           at[1].orthotropic->shear_moduli *= 1.0 + t;
         });
  for (const int region : {0, 1}) {
    expect(by.density[region],
           [region](double t, std::vector<element::Material>& at) {
             at[region].density += t;
           });
    expect(by.thermal_expansion[region],
           [region](double t, std::vector<element::Material>& at) {
             at[region].thermal_expansion.array() += t;
           });
  }
}

TEST_P(Rates, RefusesOtherLoads) {
  loads::LoadCase load_case = gradient_parts::held("one");
  load_case.pressures = {{"z1", 1.0}};
  const loads::LoadGradient gradient =
      loads::load_gradient(mesh_, materials_, load_case, v_);
  loads::LoadCase rates;
  EXPECT_THROW(loads::load_rate(gradient, rates), InvalidInput);
  rates.pressures = {
      {.surface = "z1", .field = [](const Vec3&) { return 1.0; }}};
  EXPECT_THROW(loads::load_rate(gradient, rates), InvalidInput);
}

TEST_P(Rates, IntrusionIntoABall) {
  const Vec3 centre(2.0, 0.5, 0.6);
  const loads::SlopedField ball{
      [&](const Vec3& x) { return 1.0 - (x - centre).norm(); },
      [&](const Vec3& x) { return Vec3((centre - x).normalized()); }};
  double largest = -1.0;
  for (const Vec3& x : mesh_.nodes) {
    largest = std::max(largest, ball.value(x));
  }
  const double smooth =
      functionals::intrusion_functional(mesh_, ball, 200.0).value;
  EXPECT_GE(smooth, largest);
  EXPECT_LE(smooth, largest + std::log(1.0 * mesh_.nodes.size()) / 200.0);
  derivatives::expect_partials(
      mesh_, v_, [&](const TetMesh& mesh, const VectorX&) {
        return functionals::intrusion_functional(mesh, ball, 30.0);
      });
  EXPECT_THROW(functionals::intrusion_functional(mesh_, ball, 0.0),
               InvalidInput);
  EXPECT_THROW(functionals::intrusion_functional(mesh_, {ball.value, {}}, 5.0),
               InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(Orders, Rates, testing::Values(1, 2));

}  // namespace
}  // namespace meniscus::rates_test
