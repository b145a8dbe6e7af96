#include "fea/shell/shell_gradient.h"

#include <gtest/gtest.h>

#include "fea/shell/shell_system.h"
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

TEST(ShellGradient, OfWorkMeetsDifferences) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX v = six_waves(shell.mesh, 1.9);
  const ShellGradient here = stiffness_gradient(shell.mesh, sections, v, u);
  derivatives::Check check;
  Points move;
  for (const Vec3& x : shell.mesh.nodes) {
    move.push_back(derivatives::wave(x, 0.7));
  }
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return stiffness_gradient(moved, sections, v, u).value;
  });
  check.exact = 0.0;
  check.scale = 0.0;
  for (std::size_t f = 0; f < here.by_thickness.size(); ++f) {
    const Vec3 dt = 0.05 * derivatives::wave(shell.mesh.nodes[f], 0.2);
    check.exact += here.by_thickness[f].dot(dt);
    check.scale += here.by_thickness[f].cwiseProduct(dt).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh thicker = shell.mesh;
    for (std::size_t f = 0; f < thicker.thickness.size(); ++f) {
      thicker.thickness[f] +=
          h * 0.05 * derivatives::wave(shell.mesh.nodes[f], 0.2);
    }
    return stiffness_gradient(thicker, sections, v, u).value;
  });
}

/// Its value is the work of the assembled stiffness, and minus its derivative
/// that of the compliance.
TEST(ShellGradient, OfComplianceMeetsSolvedDifferences) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = layered();
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports,
                     shell.nodes([](double s, double) { return s < 1e-9; }),
                     "xyzabc");
  ShellLoads loads;
  loads.nodal = six_waves(shell.mesh, 0.5);
  const auto compliance = [&](const ShellMesh& mesh) {
    const ShellSystem system(mesh, sections, supports);
    return loads.nodal.dot(system.solve(loads).displacement);
  };
  const ShellSystem system(shell.mesh, sections, supports);
  const ShellSolution solution = system.solve(loads);
  const ShellGradient here = stiffness_gradient(
      shell.mesh, sections, solution.displacement, solution.displacement);
  EXPECT_NEAR(here.value / (2.0 * solution.strain_energy), 1.0, 1e-10);
  Points move;
  for (const Vec3& x : shell.mesh.nodes) {
    move.push_back(derivatives::wave(x, 0.7));
  }
  derivatives::Check check;
  check.tolerance = 1e-7;
  check.exact = -flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return compliance(moved);
  });
}

}  // namespace
}  // namespace meniscus::shell_gradient_test
