#include "fea/shell_actions/shell_lines.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/shell/shell_moments.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_lines_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::MappedShell;

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 2.0;
constexpr double kHeight = 3.0;
constexpr double kThickness = 0.1;

/// A quarter of a cylinder about z.
MappedShell quarter() {
  return shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double angle = 0.5 * kPi * s;
        return {kRadius * std::cos(angle), kRadius * std::sin(angle),
                kHeight * t};
      },
      kThickness, {.m = 8, .n = 4});
}

Line foot(const MappedShell& shell) {
  return shell.edges([](double, double t) { return t < 1e-9; });
}

VectorX waves(const ShellMesh& mesh, double phase) {
  VectorX u(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    u[i] = std::sin(phase + 0.7 * static_cast<double>(i));
  }
  return u;
}

Eigen::Map<const VectorX> flat(const Points& points) {
  return {points.front().data(), static_cast<Eigen::Index>(3 * points.size())};
}

// Quadratics through three points of an arc of 11 degrees: h^4 of its length.
constexpr double kArc = 1e-5;

TEST(ShellLines, AreAsLongAsTheirCurve) {
  const MappedShell shell = quarter();
  EXPECT_NEAR(line_length(shell.mesh, foot(shell)), 0.5 * kPi * kRadius,
              kArc * kRadius);
}

TEST(ShellLines, MeanOfRigidMotionIsIt) {
  const MappedShell shell = quarter();
  const Vec3 move(0.1, -0.2, 0.3);
  const double turn = 0.05;  // about z
  VectorX u =
      VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
  for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
    u.segment<3>(6L * static_cast<Eigen::Index>(i)) =
        move + turn * Vec3::UnitZ().cross(shell.mesh.nodes[i]);
  }
  // The middle of a quarter's arc is at 2 r / pi along both axes.
  const double middle = 2.0 * kRadius / kPi;
  const Line line = foot(shell);
  EXPECT_NEAR(mean_displacement(shell.mesh, line, {2, 0, 0}, u).value,
              move.x() - turn * middle, kArc);
  EXPECT_NEAR(mean_displacement(shell.mesh, line, {0, 1, 0}, u).value,
              move.y() + turn * middle, kArc);
}

TEST(ShellLines, DerivativesMeetDifferences) {
  const MappedShell shell = quarter();
  const Line line = foot(shell);
  const VectorX u = waves(shell.mesh, 0.3);
  const Vec3 d(1.0, -2.0, 0.5);
  const LineMean here = mean_displacement(shell.mesh, line, d, u);
  Points move(shell.mesh.nodes.size());
  for (std::size_t i = 0; i < move.size(); ++i) {
    const auto k = static_cast<double>(i);
    move[i] = Vec3(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k + 1.0));
  }
  const auto moved = [&](double h) {
    ShellMesh mesh = shell.mesh;
    for (std::size_t i = 0; i < move.size(); ++i) {
      mesh.nodes[i] += 0.01 * h * move[i];
    }
    return mesh;
  };
  derivatives::Check check;
  check.exact = 0.01 * flat(here.by_nodes).dot(flat(move));
  check.scale = 0.01 * flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    return mean_displacement(moved(h), line, d, u).value;
  });
  const VectorX more = waves(shell.mesh, 1.1);
  check.exact = here.by_displacement.dot(more);
  check.scale = here.by_displacement.cwiseProduct(more).lpNorm<1>();
  derivatives::expect_derivative(check, [&](double h) {
    return mean_displacement(shell.mesh, line, d, u + h * more).value;
  });
  const Vec3 turn(0.3, 0.2, -0.4);
  check.exact = here.by_direction.dot(turn);
  check.scale = here.by_direction.norm() * turn.norm();
  derivatives::expect_derivative(check, [&](double h) {
    return mean_displacement(shell.mesh, line, d + h * turn, u).value;
  });
}

TEST(ShellLines, RefusesWhatHasNoLength) {
  const MappedShell shell = quarter();
  const VectorX u = waves(shell.mesh, 0.0);
  EXPECT_THROW(mean_displacement(shell.mesh, {}, {1, 0, 0}, u), InvalidInput);
  EXPECT_THROW(mean_displacement(shell.mesh, foot(shell), {0, 0, 0}, u),
               InvalidInput);
}

/// Of a cylinder's wall with its curvature: half of it outside, half inside.
TEST(ShellMass, IsThatOfTheWall) {
  const MappedShell shell = quarter();
  std::vector<Section> sections = {shell_shapes::isotropic(1.0, 0.3, 7.0)};
  const double area = 0.5 * kPi * kRadius * kHeight;
  EXPECT_NEAR(mass_moments(shell.mesh, sections, Vec3::Zero()).mass,
              7.0 * area * kThickness, kArc * area);
  sections[0].offset = 0.5;  // all of it outside
  EXPECT_NEAR(mass_moments(shell.mesh, sections, Vec3::Zero()).mass,
              7.0 * area * kThickness * (1.0 + 0.5 * kThickness / kRadius),
              10.0 * kArc * area);
}

}  // namespace
}  // namespace meniscus::shell_lines_test
