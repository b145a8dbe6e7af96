// Pressures and temperatures that differ from place to place.
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/element/stress_measures.h"
#include "fea/functionals/stress_criteria.h"
#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "fea/shell_modes/shell_mode_works.h"
#include "fea/shell_peaks/shell_norm.h"
#include "fea/shell_peaks/shell_peak_bound.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_fields_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::MappedShell;

/// A number by place, and its gradient.
struct Field {
  std::function<double(const Vec3&)> value;
  std::function<Vec3(const Vec3&)> slope;
};

Field wavy(double size, double phase) {
  return {[=](const Vec3& x) {
            return size * (1.2 + std::sin(0.9 * x.x() - 1.1 * x.y() + phase) *
                                     std::cos(0.7 * x.z()));
          },
          [=](const Vec3& x) -> Vec3 {
            const double a = 0.9 * x.x() - 1.1 * x.y() + phase;
            return size * Vec3(0.9 * std::cos(a) * std::cos(0.7 * x.z()),
                               -1.1 * std::cos(a) * std::cos(0.7 * x.z()),
                               -0.7 * std::sin(a) * std::sin(0.7 * x.z()));
          }};
}

void add_pressure(const ShellMesh& mesh, const Field& field, WallSide side,
                  ShellLoads& loads) {
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    FieldPressure& load = loads.field_pressures.emplace_back();
    load.facet = f;
    load.side = side;
    for (int i = 0; i < kNodes; ++i) {
      const Vec3& x = mesh.nodes[mesh.facets[f][i]];
      load.pressure.value[i] = field.value(x);
      load.pressure.slope[i] = field.slope(x);
    }
  }
}

void set_temperature(const ShellMesh& mesh, const Field& field,
                     ShellLoads& loads) {
  NodalTemperature& heat = loads.nodal_temperature.emplace();
  heat.value.resize(static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    heat.value[static_cast<Eigen::Index>(i)] = field.value(mesh.nodes[i]);
    heat.slope.push_back(field.slope(mesh.nodes[i]));
  }
}

MappedShell saddle() {
  return shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {s, 1.3 * t, 0.4 * s * s - 0.3 * t * t + 0.2 * s * t};
      },
      0.08, {.m = 2, .n = 2, .cut = Cut::Mixed, .shake = 0.2});
}

std::vector<Section> layered() {
  element::Material fiber{"fiber", 1.0, 0.3, 1.0, {}};
  fiber.thermal_expansion = {1e-3, 3e-3, 3e-3};
  fiber.orthotropic = element::Orthotropic{
      {130.0, 9.0, 9.0}, {0.3, 0.3, 0.4}, {5.0, 5.0, 3.0}, {}};
  Section section;
  section.laminate.plies = {{fiber, 1.0, 0.4}, {fiber, 2.0, -0.7}};
  section.offset = 0.3;
  section.direction = Vec3(1.0, 0.4, 0.2);
  return {section};
}

VectorX six_waves(const ShellMesh& mesh, double phase) {
  VectorX v(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    v.segment<3>(at) = derivatives::wave(mesh.nodes[i], phase);
    v.segment<3>(at + 3) = derivatives::wave(mesh.nodes[i], phase + 1.0);
  }
  return v;
}

Mat3 turning() {
  Mat3 slope;
  slope << 4.0, -1.0, 0.5, 2.0, 3.0, -0.7, 0.1, 0.9, -5.0;
  return slope;
}

ShellLoads wavy_loads(const ShellMesh& mesh) {
  ShellLoads loads;
  add_pressure(mesh, wavy(2.0, 0.3), WallSide::Negative, loads);
  add_pressure(mesh, wavy(-0.8, 1.9), WallSide::Positive, loads);
  set_temperature(mesh, wavy(25.0, 0.8), loads);
  loads.gravity = {0.5, 3.0, -9.0};
  return loads;
}

TEST(ShellFields, ThatAreEverywhereTheSameAreNumbers) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  ShellLoads numbers;
  for (int f = 0; f < static_cast<int>(shell.mesh.facets.size()); ++f) {
    numbers.pressures.push_back({f, 1.7, WallSide::Negative});
    numbers.pressures.push_back({f, -0.6, WallSide::Positive});
  }
  numbers.temperature = WallTemperature{.mean = 30.0};
  const auto same = [](double value) -> Field {
    return {[=](const Vec3&) { return value; },
            [](const Vec3&) -> Vec3 { return Vec3::Zero(); }};
  };
  ShellLoads fields;
  add_pressure(shell.mesh, same(1.7), WallSide::Negative, fields);
  add_pressure(shell.mesh, same(-0.6), WallSide::Positive, fields);
  set_temperature(shell.mesh, same(30.0), fields);
  const VectorX f = nodal_forces(shell.mesh, sections, numbers);
  EXPECT_LT((nodal_forces(shell.mesh, sections, fields) - f).norm(),
            1e-13 * f.norm());
  const VectorX u = six_waves(shell.mesh, 0.3);
  const auto a = shell_stress(shell.mesh, sections, numbers, u);
  const auto b = shell_stress(shell.mesh, sections, fields, u);
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (int i = 0; i < kNodes; ++i) {
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(a[k][i].negative[c], b[k][i].negative[c], 1e-11);
        EXPECT_NEAR(a[k][i].positive[c], b[k][i].positive[c], 1e-11);
      }
    }
  }
}

/// Its strains are compatible, and its displacements quadratic.
TEST(ShellFields, ALinearTemperatureBendsAFreePlateInItsPlaneWithoutStress) {
  constexpr double kAlpha = 1e-5;
  constexpr double kE = 2e5;
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {2.0 * s, 1.5 * t, 0.0};
      },
      0.1,
      {.m = 3, .n = 3, .cut = Cut::Mixed, .shake = 0.25, .straight = true});
  std::vector<Section> sections = {shell_shapes::isotropic(kE, 0.3)};
  sections[0].laminate.plies[0].material.thermal_expansion.setConstant(kAlpha);
  ShellLoads loads;
  set_temperature(
      shell.mesh,
      {[](const Vec3& x) { return 5.0 + 20.0 * x.x() - 7.0 * x.y(); },
       [](const Vec3&) -> Vec3 {
         return {20.0, -7.0, 0.0};
       }},
      loads);
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports, {shell.node(0.0, 0.0)}, "xyzabc");
  const ShellSystem system(shell.mesh, sections, supports);
  const VectorX u = system.solve(loads).displacement;
  for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
    const double x = shell.mesh.nodes[i].x();
    const double y = shell.mesh.nodes[i].y();
    const Eigen::Vector2d exact =
        kAlpha *
        Eigen::Vector2d(5.0 * x + 10.0 * (x * x - y * y) - 7.0 * x * y,
                        5.0 * y - 3.5 * (y * y - x * x) + 20.0 * x * y);
    EXPECT_LT((u.segment<2>(static_cast<Eigen::Index>(6 * i)) - exact).norm(),
              1e-8 * 70.0 * kAlpha);
  }
  for (const FacetStress& facet :
       shell_stress(shell.mesh, sections, loads, u)) {
    for (const WallStress& wall : facet) {
      EXPECT_LT(element::von_mises(wall.middle), 1e-6 * kE * kAlpha * 40.0);
    }
  }
}

/// A tank's wall, free at both ends, under water: its radius grows by
/// p R^2 / (E t), linear over the height, which bends nothing.
TEST(ShellFields, WaterWidensATank) {
  constexpr double kR = 2.0;
  constexpr double kH = 3.0;
  constexpr double kWall = 8e-3;
  constexpr double kE = 2e5;
  constexpr double kWeight = 0.01;
  double error[2] = {};
  for (int k = 0; k < 2; ++k) {
    const int cells = k == 0 ? 6 : 12;
    const MappedShell shell = shell_shapes::mapped_shell(
        [](double s, double t) -> Vec3 {
          const double angle = 0.5 * std::numbers::pi * s;
          return {kR * std::cos(angle), kR * std::sin(angle), kH * t};
        },
        kWall, {.m = cells, .n = cells});
    const std::vector<Section> sections = {shell_shapes::isotropic(kE, 0.3)};
    ShellLoads loads;
    add_pressure(shell.mesh,
                 {[](const Vec3& x) { return kWeight * (kH - x.z()); },
                  [](const Vec3&) -> Vec3 {
                    return {0.0, 0.0, -kWeight};
                  }},
                 WallSide::Negative, loads);
    std::vector<NodeSupport> supports;
    const auto where = [&](const auto& holds) { return shell.nodes(holds); };
    shell_shapes::hold(supports,
                       where([](double s, double) { return s < 1e-9; }), "yac");
    shell_shapes::hold(supports,
                       where([](double s, double) { return s > 1.0 - 1e-9; }),
                       "xbc");
    shell_shapes::hold(supports,
                       where([](double, double t) { return t < 1e-9; }), "z");
    const ShellSystem system(shell.mesh, sections, supports);
    const VectorX u = system.solve(loads).displacement;
    const double most = kWeight * kH * kR * kR / (kE * kWall);
    double sum = 0.0;
    for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
      const Vec3& x = shell.mesh.nodes[i];
      const Vec3 out = Vec3(x.x(), x.y(), 0.0) / kR;
      const double found =
          out.dot(u.segment<3>(static_cast<Eigen::Index>(6 * i)));
      sum += std::pow(found / most - (1.0 - x.z() / kH), 2);
    }
    error[k] = std::sqrt(sum / static_cast<double>(shell.mesh.nodes.size()));
  }
  EXPECT_LT(error[1], 5e-3);
  EXPECT_LT(error[1], error[0] / 3.0);
}

/// The value of loads on a mesh, and its derivatives by both.
struct Derived {
  double value = 0.0;
  Points by_nodes;
  ActionGradient by_actions;
};
using Functional =
    std::function<Derived(const ShellMesh& mesh, const ShellLoads& loads)>;

/// All places move, and the fields with them; then the loads change.
void expect_derivatives(const Functional& functional) {
  const MappedShell shell = saddle();
  const Derived here = functional(shell.mesh, wavy_loads(shell.mesh));
  derivatives::Check check;
  check.step = 2e-4;
  check.tolerance = 1e-7;
  Points move;
  for (const Vec3& x : shell.mesh.nodes) {
    move.push_back(derivatives::wave(x, 0.7));
  }
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return functional(moved, wavy_loads(moved)).value;
  });
  // Fields with the same values where they stand do not move the fields.
  const auto loads_at = [&](double h) {
    ShellLoads loads = wavy_loads(shell.mesh);
    add_pressure(shell.mesh, wavy(0.6 * h, 2.2), WallSide::Negative, loads);
    add_pressure(shell.mesh, wavy(0.9 * h, 0.1), WallSide::Positive, loads);
    loads.pressures.push_back({1, 1.4 * h, WallSide::Negative});
    loads.temperature = WallTemperature{.mean = 3.0 * h};
    loads.gravity += h * Vec3(9.0, -7.0, 20.0);
    loads.mass_force = MassForce{h * Vec3(5.0, 11.0, -8.0), h * turning()};
    ShellLoads more;
    set_temperature(shell.mesh, wavy(8.0, 1.0), more);
    loads.nodal_temperature->value += h * more.nodal_temperature->value;
    return loads;
  };
  ShellLoads rates;
  add_pressure(shell.mesh, wavy(0.6, 2.2), WallSide::Negative, rates);
  add_pressure(shell.mesh, wavy(0.9, 0.1), WallSide::Positive, rates);
  rates.pressures.push_back({1, 1.4, WallSide::Negative});
  rates.temperature = WallTemperature{.mean = 3.0};
  rates.gravity = Vec3(9.0, -7.0, 20.0);
  rates.mass_force = MassForce{Vec3(5.0, 11.0, -8.0), turning()};
  set_temperature(shell.mesh, wavy(8.0, 1.0), rates);
  check.exact = action_rate(shell.mesh, here.by_actions, rates);
  check.scale = here.by_actions.mass.gravity.lpNorm<1>() * 40.0;
  for (const ByLoads& by : here.by_actions.facets) {
    check.scale +=
        by.row(0).lpNorm<1>() * 10.0 + by.bottomRows<2>().lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    return functional(shell.mesh, loads_at(h)).value;
  });
}

TEST(ShellFields, ResidualsMeetDifferences) {
  const std::vector<Section> sections = layered();
  const MappedShell shell = saddle();
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX v = six_waves(shell.mesh, 1.9);
  expect_derivatives(
      [&](const ShellMesh& mesh, const ShellLoads& loads) -> Derived {
        ShellGradient gradient = residual_gradient(mesh, sections, loads, v, u);
        return {gradient.value, gradient.by_nodes, gradient.by_actions};
      });
}

TEST(ShellFields, StressNormsMeetDifferences) {
  const std::vector<Section> sections = layered();
  const MappedShell shell = saddle();
  const VectorX u = six_waves(shell.mesh, 0.3);
  expect_derivatives(
      [&](const ShellMesh& mesh, const ShellLoads& loads) -> Derived {
        StressNorm norm =
            von_mises_norm(mesh, sections, loads, u, 6.0, NormDerivatives::All);
        return {norm.value, norm.by_nodes, norm.by_actions};
      });
}

TEST(ShellFields, PeaksMeetDifferences) {
  const std::vector<Section> sections = layered();
  const MappedShell shell = saddle();
  const VectorX u = six_waves(shell.mesh, 0.3);
  const functionals::NodeCriterion criterion =
      functionals::von_mises_ratio({10.0, 20.0});
  expect_derivatives(
      [&](const ShellMesh& mesh, const ShellLoads& loads) -> Derived {
        ShellPeakBound bound = shell_peak_bound({mesh,
                                                 sections,
                                                 mesh.section,
                                                 {{loads, u}},
                                                 0.05,
                                                 element::Derivatives::All},
                                                criterion);
        return {bound.value, bound.by_nodes, bound.by_state_actions.front()};
      });
}

TEST(ShellFields, WorksOfBucklingMeetDifferences) {
  const std::vector<Section> sections = layered();
  const MappedShell shell = saddle();
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX x = six_waves(shell.mesh, 1.9);
  expect_derivatives(
      [&](const ShellMesh& mesh, const ShellLoads& loads) -> Derived {
        ModeWork work = geometric_work(mesh, sections, loads, u, x);
        return {work.value, work.by_nodes, work.by_actions};
      });
}

TEST(ShellFields, RefusesTemperaturesOfOtherNodes) {
  const MappedShell shell = saddle();
  ShellLoads loads;
  loads.nodal_temperature = NodalTemperature{VectorX::Zero(3), {}};
  EXPECT_THROW(nodal_forces(shell.mesh, layered(), loads), InvalidInput);
  loads = {};
  loads.field_pressures.push_back({99, {}, WallSide::Negative});
  EXPECT_THROW(nodal_forces(shell.mesh, layered(), loads), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_fields_test
