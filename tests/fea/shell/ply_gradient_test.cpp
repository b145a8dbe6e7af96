/// Derivatives by what plies are made of and how they lie, of all that a shell
/// comes to.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_moments.h"
#include "fea/shell/shell_system.h"
#include "fea/shell_modes/shell_mode_works.h"
#include "fea/shell_peaks/shell_norm.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::ply_gradient_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::MappedShell;

MappedShell two_films() {
  MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {s, 1.3 * t, 0.4 * s * s - 0.3 * t * t + 0.2 * s * t};
      },
      0.08, {.m = 2, .n = 2, .cut = Cut::Mixed, .shake = 0.2});
  for (std::size_t f = 0; f < shell.mesh.section.size(); f += 2) {
    shell.mesh.section[f] = 1;
  }
  return shell;
}

element::Material fiber() {
  element::Material m{"fiber", 1.0, 0.3, 1.4, {}};
  m.thermal_expansion = {1e-3, 3e-3, 3e-3};
  m.orthotropic = element::Orthotropic{
      {130.0, 9.0, 9.0}, {0.3, 0.3, 0.4}, {5.0, 5.0, 3.0}, {}};
  return m;
}

/// One of three plies, one of one.
std::vector<Section> sections() {
  element::Material core{"core", 20.0, 0.25, 0.6, {}};
  core.thermal_expansion = Vec3::Constant(2e-3);
  Section sandwich;
  sandwich.laminate.plies = {
      {fiber(), 1.0, 0.4}, {core, 3.0, 0.0}, {fiber(), 2.0, -0.7}};
  sandwich.offset = 0.3;
  sandwich.direction = Vec3(1.0, 0.4, 0.2);
  Section plain;
  plain.laminate.plies = {{core}};
  return {sandwich, plain};
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

ShellLoads some_loads(const ShellMesh& mesh) {
  ShellLoads loads;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    loads.pressures.push_back({f, 1.0 + 0.3 * f, WallSide::Negative});
    loads.pressures.push_back({f, 0.4, WallSide::Positive});
  }
  loads.gravity = {0.5, 3.0, -9.0};
  loads.spin = loads::Spin{{0.2, -0.1, 0.3}, {1.0, 2.0, 3.0}, 1.7};
  loads.temperature = WallTemperature{.mean = 30.0, .across = 12.0};
  return loads;
}

/// All plies stiffer, heavier and turned at once, each by its own amount.
std::vector<Section> changed(double h) {
  std::vector<Section> all = sections();
  double k = 1.0;
  for (Section& section : all) {
    for (Ply& ply : section.laminate.plies) {
      const double more = 1.0 + 0.1 * k * h;
      if (ply.material.orthotropic) {
        ply.material.orthotropic->youngs_moduli *= more;
        ply.material.orthotropic->shear_moduli *= more;
      } else {
        ply.material.youngs_modulus *= more;
      }
      ply.material.density += 0.3 * k * h;
      ply.angle += 0.2 * k * h;
      k *= -1.3;
    }
  }
  return all;
}

double along(const PlyGradients& by) {
  double sum = 0.0;
  double k = 1.0;
  const std::vector<Section> all = sections();
  for (std::size_t s = 0; s < all.size(); ++s) {
    for (std::size_t p = 0; p < all[s].laminate.plies.size(); ++p) {
      const element::Material& m = all[s].laminate.plies[p].material;
      const double modulus = m.orthotropic ? 1.0 : m.youngs_modulus;
      sum += 0.1 * k * modulus * by[s][p].modulus + 0.3 * k * by[s][p].density +
             0.2 * k * by[s][p].angle;
      k *= -1.3;
    }
  }
  return sum;
}

void expect_rate(
    const PlyGradients& by,
    const std::function<double(const std::vector<Section>& of)>& value) {
  derivatives::Check check;
  check.exact = along(by);
  check.scale = std::abs(check.exact);
  derivatives::expect_derivative(check,
                                 [&](double h) { return value(changed(h)); });
}

TEST(PlyGradient, OfResidualsMeetsDifferences) {
  const MappedShell shell = two_films();
  const ShellLoads loads = some_loads(shell.mesh);
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX v = six_waves(shell.mesh, 1.9);
  expect_rate(residual_gradient(shell.mesh, sections(), loads, v, u).by_ply,
              [&](const std::vector<Section>& of) {
                return residual_gradient(shell.mesh, of, loads, v, u).value;
              });
}

TEST(PlyGradient, OfMassMeetsDifferences) {
  const MappedShell shell = two_films();
  const MassForm mass{.constant = 1.0};
  expect_rate(mass_integral(shell.mesh, sections(), mass, Vec3::Zero()).by_ply,
              [&](const std::vector<Section>& of) {
                return mass_moments(shell.mesh, of, Vec3::Zero()).mass;
              });
  const Vec3 from(0.1, 0.4, -0.2);
  MassForm form{.constant = 0.3, .linear = {1.0, -2.0, 0.5}};
  form.square << 1.0, 0.2, 0.3, 0.2, 2.0, -0.4, 0.3, -0.4, 0.5;
  expect_rate(mass_integral(shell.mesh, sections(), form, from).by_ply,
              [&](const std::vector<Section>& of) {
                return mass_integral(shell.mesh, of, form, from).value;
              });
}

TEST(PlyGradient, OfAStressNormMeetsDifferences) {
  const MappedShell shell = two_films();
  const ShellLoads loads = some_loads(shell.mesh);
  const VectorX u = six_waves(shell.mesh, 0.3);
  expect_rate(von_mises_norm(shell.mesh, sections(), loads, u, 6.0,
                             NormDerivatives::All)
                  .by_ply,
              [&](const std::vector<Section>& of) {
                return von_mises_norm(shell.mesh, of, loads, u, 6.0,
                                      NormDerivatives::None)
                    .value;
              });
}

TEST(PlyGradient, OfModesWorksMeetsDifferences) {
  const MappedShell shell = two_films();
  const ShellLoads loads = some_loads(shell.mesh);
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX x = six_waves(shell.mesh, 1.9);
  expect_rate(geometric_work(shell.mesh, sections(), loads, u, x).by_ply,
              [&](const std::vector<Section>& of) {
                return geometric_work(shell.mesh, of, loads, u, x).value;
              });
  expect_rate(inertia_work(shell.mesh, sections(), x).by_ply,
              [&](const std::vector<Section>& of) {
                return inertia_work(shell.mesh, of, x).value;
              });
}

/// By the adjoint and by solving again.
TEST(PlyGradient, OfADisplacementMeetsSolvedDifferences) {
  const MappedShell shell = two_films();
  const ShellLoads loads = some_loads(shell.mesh);
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports,
                     shell.nodes([](double s, double) { return s < 1e-9; }),
                     "xyzabc");
  VectorX weights =
      VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
  weights[6L * shell.node(1.0, 1.0) + 2] = 1.0;
  const std::vector<Section> here = sections();
  const ShellSystem system(shell.mesh, here, supports);
  expect_rate(
      residual_gradient(shell.mesh, here, loads, system.solve_forces(weights),
                        system.solve(loads).displacement)
          .by_ply,
      [&](const std::vector<Section>& of) {
        const ShellSystem other(shell.mesh, of, supports);
        return weights.dot(other.solve(loads).displacement);
      });
}

}  // namespace
}  // namespace meniscus::ply_gradient_test
