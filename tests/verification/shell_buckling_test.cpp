/// Shells that buckle, against closed forms.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/math/dense.h"
#include "fea/shell_modes/shell_modes.h"
#include "tests/support/shell_benchmarks.h"

namespace meniscus::shell_buckling_test {
namespace {

using shell_benchmarks::buckling_factors;
using shell_shapes::Cut;
using shell_shapes::hold;
using shell_shapes::isotropic;
using shell_shapes::MappedShell;

constexpr double kPi = std::numbers::pi;
constexpr double kYoung = 1e4;

bool low(double s) { return s < 1e-9; }
bool high(double s) { return s > 1.0 - 1e-9; }

double draw(std::mt19937& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

void report(const std::string& name, double found, double exact) {
  std::cout << fmt::format("{}: {:.5g} of {:.5g}, {:+.2f} %\n", name, found,
                           exact, 100.0 * (found / exact - 1.0));
}

/// Adds the edge's share of forces per length.
void spread(const MappedShell& shell, const std::array<int, 3>& edge,
            const std::function<Vec3(const Vec3& x)>& force, VectorX& nodal) {
  for (const shell::LinePoint& p : shell::line_points(shell.mesh, edge)) {
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      x += p.shape[i] * shell.mesh.nodes[edge[i]];
    }
    for (int i = 0; i < 3; ++i) {
      nodal.segment<3>(6L * edge[i]) +=
          p.weight * p.tangent.norm() * p.shape[i] * force(x);
    }
  }
}

/// Edges of one facet only whose nodes are `where`.
std::vector<std::array<int, 3>> rims(
    const shell::ShellMesh& mesh,
    const std::function<bool(const Vec3& x)>& where) {
  std::vector<std::array<int, 3>> result;
  for (const auto& f : mesh.facets) {
    for (int k = 0; k < 3; ++k) {
      const std::array<int, 3> edge = {f[k], f[(k + 1) % 3], f[3 + k]};
      if (std::all_of(edge.begin(), edge.end(),
                      [&](int i) { return where(mesh.nodes[i]); })) {
        result.push_back(edge);
      }
    }
  }
  return result;
}

/// A cylinder, or a panel of one, whose stress before it buckles is even.
struct Cylinder {
  double R, L, h, nu;
  double along, around;  // stress resultants [force/length]
};

/// Of waves sin(m pi x / L) and n around: strains of Sanders and Koiter, all of
/// the gradient in the stresses' work; pressures keep their direction.
double factor_of_waves(const Cylinder& c, int m, double n) {
  const double k = m * kPi / c.L;
  const double R = c.R;
  Mat3 stretch;
  stretch << -k, 0, 0,  //
      0, n / R, 1 / R,  //
      -n / R, k, 0;
  Mat3 bend;
  bend << 0, 0, k * k,                  //
      0, n / (R * R), n * n / (R * R),  //
      n / (2 * R * R), 1.5 * k / R, 2 * k * n / R;
  Mat3 law;
  law << 1, c.nu, 0, c.nu, 1, 0, 0, 0, 0.5 * (1 - c.nu);
  law *= kYoung * c.h / (1 - c.nu * c.nu);
  const Mat3 K = stretch.transpose() * law * stretch +
                 c.h * c.h / 12.0 * bend.transpose() * law * bend;
  // Around, v and w turn into each other.
  Mat3 around = n * n * Mat3::Identity();
  around.bottomRightCorner<2, 2>() += Eigen::Matrix2d::Identity();
  around(1, 2) = around(2, 1) = 2.0 * n;
  const Mat3 A =
      -c.along * k * k * Mat3::Identity() - c.around / (R * R) * around;
  const auto own = symmetric_eigen(K);
  const Mat3 root =
      own.vectors * own.values.cwiseSqrt().cwiseInverse().asDiagonal();
  const Mat3 theta = root.transpose() * A * root;
  return 1.0 / std::max(1e-12, symmetric_eigen(theta).values[2]);
}

/// The least of even numbers of waves around, 0 too of a whole cylinder.
double exact_factor(const Cylinder& c, bool is_panel) {
  double least = 1e300;
  for (int m = 1; m <= 40; ++m) {
    for (int n = is_panel ? 2 : 0; n <= 60; n += 2) {
      least = std::min(least, factor_of_waves(c, m, n));
    }
  }
  return least;
}

/// A quarter: its sides planes of symmetry, or of a panel hinged; ends hinged.
/// What is held is held where the even stress moves it to.
double found_factor(const Cylinder& c, bool is_panel, int cells) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [&](double s, double t) -> Vec3 {
        const double a = 0.5 * kPi * s;
        return {c.R * std::cos(a), c.R * std::sin(a), c.L * t};
      },
      c.h, {.m = cells, .n = cells, .cut = Cut::Mixed});
  const double out = c.R * (c.around - c.nu * c.along) / (kYoung * c.h);
  const double strain = (c.along - c.nu * c.around) / (kYoung * c.h);
  std::vector<shell::NodeSupport> supports;
  for (std::size_t i = 0; i < shell.place.size(); ++i) {
    const auto& [s, t] = shell.place[i];
    const bool end = low(t) || high(t);
    const bool side = low(s) || high(s);
    const double a = 0.5 * kPi * s;
    shell::NodeSupport support{
        .node = static_cast<int>(i),
        .axes = element::LocalAxes{{std::cos(a), std::sin(a), 0.0},
                                   {-std::sin(a), std::cos(a), 0.0}}};
    support.value[0] = out;
    support.value[2] = strain * c.L * t;
    support.held[0] = end || (side && is_panel);
    support.held[1] = end || (side && !is_panel);
    support.held[2] = (side && is_panel) || (low(t) && low(s));
    support.held[3] = side && !is_panel;
    support.held[4] = side && is_panel;
    support.held[5] = end || (side && !is_panel);
    supports.push_back(support);
  }
  shell::ShellLoads loads;
  for (const double way : {-1.0, 1.0}) {
    for (const auto& edge : shell.edges(
             [&](double, double t) { return way < 0.0 ? low(t) : high(t); })) {
      loads.edges.push_back({.nodes = edge, .force = {0, 0, way * c.along}});
    }
  }
  for (std::size_t f = 0; f < shell.mesh.facets.size(); ++f) {
    loads.pressures.push_back({.facet = static_cast<int>(f),
                               .pressure = c.around / c.R,
                               .side = shell::WallSide::Middle});
  }
  const std::vector<shell::Section> sections = {isotropic(kYoung, c.nu)};
  const shell::ShellSystem system(shell.mesh, sections, supports);
  return buckling_factors(system, loads, 1).at(0);
}

TEST(ShellBuckling, CylindersAndPanelsDrawnAtRandom) {
  constexpr double kThinShell = 0.01;  // shear, h / R; 24 cells
  std::mt19937 random(21);
  for (int k = 0; k < 2; ++k) {
    for (const char* name : {"pressed along its axis", "under pressure",
                             "under both", "panel pressed along"}) {
      const std::string kind = name;
      const Cylinder c{
          .R = draw(random, 0.8, 1.2),
          .L = draw(random, 0.7, 1.5),
          .h = draw(random, 0.008, 0.02),
          .nu = draw(random, 0.0, 0.4),
          .along = kind == "under pressure" ? 0.0 : -draw(random, 0.5, 1.0),
          .around = kind.starts_with("under") ? -draw(random, 0.2, 1.0) : 0.0};
      const bool is_panel = kind.starts_with("panel");
      const double exact = exact_factor(c, is_panel);
      const double found = found_factor(c, is_panel, 24);
      report(fmt::format("{}, R {:.3f} L {:.3f} h {:.4f} nu {:.2f}", name, c.R,
                         c.L, c.h, c.nu),
             found, exact);
      EXPECT_NEAR(found / exact, 1.0, kThinShell);
    }
  }
}

/// A strip that stands on edge, clamped, under a force at its end: 4.013 sqrt(E
/// I G J) / L^2 (Timoshenko and Gere 1961).
TEST(ShellBuckling, ACantileverTipsOver) {
  constexpr double kRoot = 0.015;  // it cannot warp there: b / 2 L
  std::mt19937 random(22);
  for (int k = 0; k < 3; ++k) {
    const double L = draw(random, 30, 60);
    const double b = draw(random, 0.8, 1.2);
    const double t = draw(random, 0.01, 0.03);
    const double nu = draw(random, 0.0, 0.4);
    const MappedShell strip = shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          return {L * s, b * (r - 0.5), 0};
        },
        t, {.m = 60, .n = 2, .cut = Cut::Mixed});
    std::vector<shell::NodeSupport> supports;
    hold(supports, strip.nodes([](double s, double) { return low(s); }),
         "xyzabc");
    shell::ShellLoads loads;
    for (const auto& edge :
         strip.edges([](double s, double) { return high(s); })) {
      loads.edges.push_back({.nodes = edge, .force = {0, -1.0 / b, 0}});
    }
    const std::vector<shell::Section> sections = {isotropic(kYoung, nu)};
    const shell::ShellSystem system(strip.mesh, sections, supports);
    const double J = b * t * t * t / 3.0;
    const double exact =
        4.0126 / (L * L) *
        std::sqrt(kYoung * b * t * t * t / 12.0 * J * kYoung / (2 + 2 * nu));
    const double found = buckling_factors(system, loads, 1).at(0);
    report(fmt::format("strip {:.2f} x {:.3f} x {:.4f} nu {:.2f}", L, b, t, nu),
           found, exact);
    EXPECT_NEAR(found / exact, 1.0, kRoot);
  }
}

/// Two flanges and a web, in forks at both ends, under end moments: pi / L
/// sqrt(E I_z (G J + pi^2 E I_w / L^2)).
TEST(ShellBuckling, AnIBeamTipsOver) {
  constexpr double kSlender = 0.02;  // its web bends a little, too
  const double L = 60.0;
  const double height = 2.0;
  const double width = 1.5;
  const double t = 0.06;
  const double nu = 0.3;
  const shell_shapes::GridOptions grid{.m = 48, .n = 4, .cut = Cut::Slash};
  const auto flange = [&](double y) {
    return shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          return {L * s, y, width * (r - 0.5)};
        },
        t, grid);
  };
  const MappedShell web = shell_shapes::mapped_shell(
      [=](double s, double r) -> Vec3 {
        return {L * s, height * (r - 0.5), 0};
      },
      t, grid);
  const MappedShell beam = shell_shapes::joined(
      shell_shapes::joined(web, flange(-0.5 * height)), flange(0.5 * height));
  const auto at_end = [&](const Vec3& x) {
    return x[0] < 1e-9 || x[0] > L - 1e-9;
  };
  std::vector<int> of_web;
  std::vector<int> of_center;
  for (std::size_t i = 0; i < beam.mesh.nodes.size(); ++i) {
    const Vec3& x = beam.mesh.nodes[i];
    if (at_end(x) && std::abs(x[2]) < 1e-9) {
      of_web.push_back(static_cast<int>(i));
      if (std::abs(x[1]) < 1e-9 && x[0] < 1e-9) {
        of_center.push_back(static_cast<int>(i));
      }
    }
  }
  std::vector<shell::NodeSupport> supports;
  hold(supports, of_web, "yz");
  hold(supports, of_center, "x");
  shell::ShellLoads loads;
  loads.nodal = VectorX::Zero(6L * static_cast<long>(beam.mesh.nodes.size()));
  for (const auto& edge : rims(beam.mesh, at_end)) {
    spread(
        beam, edge,
        [&](const Vec3& x) -> Vec3 {
          const double way = x[0] > 0.5 * L ? -1.0 : 1.0;
          return {way * x[1] * t, 0, 0};  // a stress of y
        },
        loads.nodal);
  }
  const std::vector<shell::Section> sections = {isotropic(kYoung, nu)};
  const shell::ShellSystem system(beam.mesh, sections, supports);
  const double strong = t * height * height * height / 12.0 +
                        2.0 * width * t * height * height / 4.0;
  const double weak = 2.0 * t * width * width * width / 12.0;
  const double J = (2.0 * width + height) * t * t * t / 3.0;
  const double warping = weak * height * height / 4.0;
  const double exact = kPi / L *
                       std::sqrt(kYoung * weak *
                                 (kYoung / (2 + 2 * nu) * J +
                                  kPi * kPi * kYoung * warping / (L * L)));
  const double found = buckling_factors(system, loads, 1).at(0) * strong;
  report("I beam", found, exact);
  EXPECT_NEAR(found / exact, 1.0, kSlender);
}

/// Equal legs whose ends are hinged, pressed: each is a plate with three hinged
/// sides, D / b^2 (6 (1 - nu) + pi^2 b^2 / L^2) (Timoshenko and Gere 1961).
TEST(ShellBuckling, AnAngleTwists) {
  constexpr double kOneTerm = 0.01;  // of Timoshenko's, from above
  const double L = 6.0;
  const double t = 0.02;
  const double nu = 0.3;
  const shell_shapes::GridOptions grid{.m = 20, .n = 5, .cut = Cut::Slash};
  const auto leg = [&](const Vec3& way) {
    return shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          return L * s * Vec3::UnitX() + r * way;
        },
        t, grid);
  };
  const MappedShell angle =
      shell_shapes::joined(leg(Vec3::UnitY()), leg(Vec3::UnitZ()));
  std::vector<shell::NodeSupport> supports;
  shell::ShellLoads loads;
  for (std::size_t i = 0; i < angle.mesh.nodes.size(); ++i) {
    const Vec3& x = angle.mesh.nodes[i];
    if (x[0] < 1e-9 || x[0] > L - 1e-9) {
      hold(supports, {static_cast<int>(i)}, "yz");
    }
    if (x.norm() < 1e-9) {
      hold(supports, {static_cast<int>(i)}, "x");
    }
  }
  for (const auto& edge : rims(angle.mesh, [&](const Vec3& x) {
         return x[0] < 1e-9 || x[0] > L - 1e-9;
       })) {
    const double way = angle.mesh.nodes[edge[0]][0] > 0.5 * L ? -1.0 : 1.0;
    loads.edges.push_back({.nodes = edge, .force = {way, 0, 0}});
  }
  const std::vector<shell::Section> sections = {isotropic(kYoung, nu)};
  const shell::ShellSystem system(angle.mesh, sections, supports);
  const double D = kYoung * t * t * t / 12.0 / (1 - nu * nu);
  const double exact = D * (6.0 * (1 - nu) + kPi * kPi / (L * L));
  const double found = buckling_factors(system, loads, 1).at(0);
  report("angle", found, exact);
  EXPECT_NEAR(found / exact, 1.0, kOneTerm);
}

}  // namespace
}  // namespace meniscus::shell_buckling_test
