#include "fea/shell/shell_moments.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_moments_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::MappedShell;

/// A quarter of a pipe, drawn at its inner face.
MappedShell quarter(int cells) {
  return shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double a = 0.5 * std::numbers::pi * s;
        return {std::cos(a), std::sin(a), 2.0 * t};
      },
      0.3, {.m = cells, .n = 4});
}

std::vector<Section> steel() {
  std::vector<Section> sections = {shell_shapes::isotropic(1.0, 0.3, 5.0)};
  sections[0].offset = 0.5;
  return sections;
}

TEST(ShellMoments, AreThoseOfAPipe) {
  constexpr double kFacets = 1e-4;  // 16 quadratic ones are no circle
  const double in = 1.0;
  const double out = 1.3;
  const MassMoments m =
      mass_moments(quarter(16).mesh, steel(), Vec3(0.0, 0.0, 1.0));
  const double area = 0.25 * std::numbers::pi * (out * out - in * in);
  EXPECT_NEAR(m.mass / (5.0 * 2.0 * area), 1.0, kFacets);
  const double first = 5.0 * 2.0 * (std::pow(out, 3) - std::pow(in, 3)) / 3.0;
  EXPECT_NEAR(m.first[0] / first, 1.0, kFacets);
  EXPECT_NEAR(m.first[2], 0.0, kFacets);
  const double polar =
      5.0 * 2.0 * std::numbers::pi / 8.0 * (std::pow(out, 4) - std::pow(in, 4));
  EXPECT_NEAR((m.second(0, 0) + m.second(1, 1)) / polar, 1.0, kFacets);
  EXPECT_NEAR(m.second(2, 2) / (m.mass / 3.0), 1.0, kFacets);
}

TEST(ShellMoments, IntegralsMeetMomentsAndDifferences) {
  constexpr double kSame = 1e-12;
  const MappedShell shell = quarter(3);
  const std::vector<Section> sections = steel();
  const Vec3 from(0.2, -0.1, 0.4);
  MassForm form{.constant = 0.7, .linear = {0.3, -0.4, 0.5}};
  form.square << 1.0, 0.2, -0.3, 0.2, 0.5, 0.1, -0.3, 0.1, 2.0;
  const ShellGradient here = mass_integral(shell.mesh, sections, form, from);
  const MassMoments m = mass_moments(shell.mesh, sections, from);
  EXPECT_NEAR(here.value,
              form.constant * m.mass + form.linear.dot(m.first) +
                  form.square.cwiseProduct(m.second).sum(),
              kSame * here.value);
  Points move;
  for (const Vec3& x : shell.mesh.nodes) {
    move.push_back(derivatives::wave(x, 0.7));
  }
  derivatives::Check check;
  check.exact = flat(here.by_nodes).dot(flat(move));
  check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
  for (std::size_t f = 0; f < here.by_thickness.size(); ++f) {
    check.exact += here.by_thickness[f].dot(move[f]);
    check.scale += here.by_thickness[f].cwiseProduct(move[f]).lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    flat(moved.nodes) += h * flat(move);
    for (std::size_t f = 0; f < moved.thickness.size(); ++f) {
      moved.thickness[f] += h * move[f];
    }
    return mass_integral(moved, sections, form, from).value;
  });
}

}  // namespace
}  // namespace meniscus::shell_moments_test
