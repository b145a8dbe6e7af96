#include "fea/shell/shell_gradient.h"

#include <gtest/gtest.h>

#include "fea/shell/shell_system.h"
#include "fea/shell_peaks/shell_norm.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_gradient_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::MappedShell;

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

/// One number per coordinate and node.
VectorX six_waves(const ShellMesh& mesh, double phase) {
  VectorX v(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    v.segment<3>(at) = derivatives::wave(mesh.nodes[i], phase);
    v.segment<3>(at + 3) = derivatives::wave(mesh.nodes[i], phase + 1.0);
  }
  return v;
}

Points wave_of(const Points& places, double phase) {
  Points move;
  for (const Vec3& x : places) {
    move.push_back(derivatives::wave(x, phase));
  }
  return move;
}

/// Loads of every kind.
ShellLoads all_loads(const MappedShell& shell) {
  ShellLoads loads;
  for (int f = 0; f < static_cast<int>(shell.mesh.facets.size()); ++f) {
    loads.pressures.push_back({f, 1.0 + 0.3 * f, WallSide::Negative});
    loads.pressures.push_back({f, 0.4, WallSide::Positive});
    loads.pressures.push_back({f, -0.7, WallSide::Middle});
  }
  for (const auto& edge :
       shell.edges([](double s, double) { return s > 1.0 - 1e-9; })) {
    loads.edges.push_back({edge, {1.0, -2.0, 0.5}, {0.2, 0.1, -0.3}});
  }
  loads.pulls = {{1, 0, 2.0}, {2, 1, -3.0}, {2, 2, 1.0}};
  loads.tractions = {{0, 1, {0.4, -1.0, 2.0}, 1.5}, {3, 2, {1.0, 0.2, -0.6}}};
  loads.gravity = {0.5, 3.0, -9.0};
  loads.spin = loads::Spin{{0.2, -0.1, 0.3}, {1.0, 2.0, 3.0}, 1.7};
  loads.temperature = WallTemperature{.mean = 30.0, .across = 12.0};
  loads.nodal = six_waves(shell.mesh, 0.5);
  return loads;
}

void expect_residual(const ShellLoads& loads) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX v = six_waves(shell.mesh, 1.9);
  const auto value = [&](const ShellMesh& mesh) {
    return residual_gradient(mesh, sections, loads, v, u).value;
  };
  const ShellGradient here =
      residual_gradient(shell.mesh, sections, loads, v, u);
  derivatives::Check check;
  const Points move = wave_of(shell.mesh.nodes, 0.7);
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return value(moved);
  });
  const Points thicker = wave_of(shell.mesh.nodes, 0.2);
  check.exact = 0.0;
  check.scale = 0.0;
  for (std::size_t f = 0; f < here.by_thickness.size(); ++f) {
    check.exact += 0.05 * here.by_thickness[f].dot(thicker[f]);
    check.scale +=
        0.05 * here.by_thickness[f].cwiseProduct(thicker[f]).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh other = shell.mesh;
    for (std::size_t f = 0; f < other.thickness.size(); ++f) {
      other.thickness[f] += 0.05 * h * thicker[f];
    }
    return value(other);
  });
}

TEST(ShellGradient, OfResidualsMeetsDifferences) {
  const MappedShell shell = saddle();
  const ShellLoads all = all_loads(shell);
  {
    SCOPED_TRACE("stiffness alone");
    expect_residual({});
  }
  {
    SCOPED_TRACE("pressures");
    expect_residual({.pressures = all.pressures});
  }
  {
    SCOPED_TRACE("edges");
    expect_residual(
        {.pulls = all.pulls, .tractions = all.tractions, .edges = all.edges});
  }
  {
    SCOPED_TRACE("weight and spin");
    expect_residual({.gravity = all.gravity, .spin = all.spin});
  }
  {
    SCOPED_TRACE("temperature");
    expect_residual({.temperature = all.temperature});
  }
}

std::vector<NodeSupport> held_side(const MappedShell& shell) {
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports,
                     shell.nodes([](double s, double) { return s < 1e-9; }),
                     "xyzabc");
  return supports;
}

/// Two codes: the tape's and the assembled one's.
TEST(ShellGradient, ItsValueIsTheSystemsResidual) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  const ShellLoads loads = all_loads(shell);
  const std::vector<NodeSupport> supports = held_side(shell);
  const ShellSystem system(shell.mesh, sections, supports);
  const ShellSolution solution = system.solve(loads);
  const VectorX v = six_waves(shell.mesh, 1.9);
  const double value =
      residual_gradient(shell.mesh, sections, loads, v, solution.displacement)
          .value;
  const double size = v.cwiseProduct(solution.reaction).lpNorm<1>();
  EXPECT_NEAR(value, -v.dot(solution.reaction), 1e-9 * size);
}

/// A displacement under all loads, by the adjoint and by solving again.
TEST(ShellGradient, OfADisplacementMeetsSolvedDifferences) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  const ShellLoads loads = all_loads(shell);
  const std::vector<NodeSupport> supports = held_side(shell);
  VectorX weights = VectorX::Zero(loads.nodal.size());
  weights[6L * shell.node(1.0, 1.0) + 2] = 1.0;
  const auto response = [&](const ShellMesh& mesh) {
    const ShellSystem system(mesh, sections, supports);
    return weights.dot(system.solve(loads).displacement);
  };
  const ShellSystem system(shell.mesh, sections, supports);
  const ShellGradient here = residual_gradient(
      shell.mesh, sections, loads, system.solve_forces(weights),
      system.solve(loads).displacement);
  const Points move = wave_of(shell.mesh.nodes, 0.7);
  derivatives::Check check;
  check.tolerance = 1e-7;
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return response(moved);
  });
}

/// By places, thicknesses and nodes' numbers, all else held.
TEST(ShellGradient, OfAStressNormMeetsDifferences) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  const ShellLoads loads = all_loads(shell);
  const VectorX u = six_waves(shell.mesh, 0.3);
  const auto value = [&](const ShellMesh& mesh, const VectorX& displacement) {
    return von_mises_norm(mesh, sections, loads, displacement, 6.0,
                          NormDerivatives::None)
        .value;
  };
  const StressNorm here =
      von_mises_norm(shell.mesh, sections, loads, u, 6.0, NormDerivatives::All);
  EXPECT_GT(here.value, 0.0);
  derivatives::Check check;
  const Points move = wave_of(shell.mesh.nodes, 0.7);
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return value(moved, u);
  });
  const Points thicker = wave_of(shell.mesh.nodes, 0.2);
  check.exact = 0.0;
  check.scale = 0.0;
  for (std::size_t f = 0; f < here.by_thickness.size(); ++f) {
    check.exact += 0.05 * here.by_thickness[f].dot(thicker[f]);
    check.scale +=
        0.05 * here.by_thickness[f].cwiseProduct(thicker[f]).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh other = shell.mesh;
    for (std::size_t f = 0; f < other.thickness.size(); ++f) {
      other.thickness[f] += 0.05 * h * thicker[f];
    }
    return value(other, u);
  });
  const VectorX more = six_waves(shell.mesh, 1.1);
  check.exact = here.by_displacement.dot(more);
  check.scale = here.by_displacement.cwiseProduct(more).lpNorm<1>();
  derivatives::expect_derivative(
      check, [&](double h) { return value(shell.mesh, u + h * more); });
}

/// A large power is near to the largest stress of the points, from below.
TEST(ShellGradient, AStressNormGrowsToThePeak) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  const VectorX u = six_waves(shell.mesh, 0.3);
  const auto norm = [&](double power) {
    return von_mises_norm(shell.mesh, sections, {}, u, power,
                          NormDerivatives::None)
        .value;
  };
  EXPECT_LT(norm(2.0), norm(8.0));
  EXPECT_LT(norm(8.0), norm(400.0));
  EXPECT_LT(norm(400.0), 1.02 * norm(200.0));
}

}  // namespace
}  // namespace meniscus::shell_gradient_test
