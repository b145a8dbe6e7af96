#include "fea/shell_modes/shell_mode_works.h"

#include <gtest/gtest.h>

#include "fea/shell_modes/shell_modes.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_mode_works_test {
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

std::vector<Section> crossed() {
  Section section;
  section.laminate.plies = {
      {element::Material{"soft", 50.0, 0.3, 2.0, {}}, 1.0, 0.4},
      {element::Material{"stiff", 90.0, 0.2, 3.0, {}}, 2.0, -0.7}};
  section.offset = 0.3;
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

ShellLoads some_loads(const MappedShell& shell) {
  ShellLoads loads;
  for (int f = 0; f < static_cast<int>(shell.mesh.facets.size()); ++f) {
    loads.pressures.push_back({f, 1.0 + 0.3 * f, WallSide::Negative});
    loads.pressures.push_back({f, 0.4, WallSide::Positive});
  }
  loads.gravity = {0.5, 3.0, -9.0};
  return loads;
}

/// Along waves of places and of thicknesses.
void expect_derivatives(
    const ShellGradient& here,
    const std::function<double(const ShellMesh& mesh)>& value) {
  const MappedShell shell = saddle();
  Points move;
  for (const Vec3& x : shell.mesh.nodes) {
    move.push_back(derivatives::wave(x, 0.7));
  }
  derivatives::Check check;
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    return value(moved);
  });
  check.exact = 0.0;
  check.scale = 0.0;
  for (std::size_t f = 0; f < here.by_thickness.size(); ++f) {
    check.exact += 0.05 * here.by_thickness[f].dot(move[f]);
    check.scale +=
        0.05 * here.by_thickness[f].cwiseProduct(move[f]).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh other = shell.mesh;
    for (std::size_t f = 0; f < other.thickness.size(); ++f) {
      other.thickness[f] += 0.05 * h * move[f];
    }
    return value(other);
  });
}

constexpr double kSame = 1e-11;

TEST(ShellModeWorks, AreProductsWithTheMatrices) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = crossed();
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports, {shell.node(0, 0)}, "xyzabc");
  const ShellSystem system(shell.mesh, sections, supports);
  const ShellLoads loads = some_loads(shell);
  const VectorX u = system.solve(loads).displacement;
  const ShellFreedom& freedom = system.freedom();
  const VectorX y = freedom.restrict(six_waves(shell.mesh, 0.4));
  const VectorX x = freedom.expand(y);
  const SparseMatrix G = system.geometric(loads, u);
  const SparseMatrix M = system.mass();
  const double by_G = y.dot(VectorX(G.selfadjointView<Eigen::Lower>() * y));
  const double by_M = y.dot(VectorX(M.selfadjointView<Eigen::Lower>() * y));
  const double size = y.cwiseAbs().dot(
      VectorX(SparseMatrix(G.cwiseAbs()).selfadjointView<Eigen::Lower>() *
              y.cwiseAbs()));
  EXPECT_NEAR(geometric_work(shell.mesh, sections, loads, u, x).value, by_G,
              kSame * size);
  EXPECT_NEAR(inertia_work(shell.mesh, sections, x).value, by_M, kSame * by_M);
  const SparseMatrix all = nodal_mass(shell.mesh, sections);
  EXPECT_NEAR(x.dot(VectorX(all.selfadjointView<Eigen::Lower>() * x)), by_M,
              kSame * by_M);
}

TEST(ShellModeWorks, OfStressesMeetDifferences) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = crossed();
  const ShellLoads loads = some_loads(shell);
  const VectorX u = six_waves(shell.mesh, 0.3);
  const VectorX x = six_waves(shell.mesh, 1.9);
  const ModeWork here = geometric_work(shell.mesh, sections, loads, u, x);
  expect_derivatives(here, [&](const ShellMesh& mesh) {
    return geometric_work(mesh, sections, loads, u, x).value;
  });
  const VectorX more = six_waves(shell.mesh, 0.8);
  derivatives::Check check;
  check.exact = here.by_displacement.dot(more);
  check.scale = here.by_displacement.cwiseProduct(more).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    return geometric_work(shell.mesh, sections, loads, u + h * more, x).value;
  });
}

TEST(ShellModeWorks, OfInertiaMeetDifferences) {
  const MappedShell shell = saddle();
  const std::vector<Section> sections = crossed();
  const VectorX x = six_waves(shell.mesh, 1.9);
  expect_derivatives(inertia_work(shell.mesh, sections, x),
                     [&](const ShellMesh& mesh) {
                       return inertia_work(mesh, sections, x).value;
                     });
}

}  // namespace
}  // namespace meniscus::shell_mode_works_test
