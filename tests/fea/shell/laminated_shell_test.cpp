/// Laminates in whole shells, against closed forms.
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::laminated_shell_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::MappedShell;

using Six6 = Eigen::Matrix<double, 6, 6>;

element::Material fiber(const Vec3& E, const Vec3& nu, const Vec3& G) {
  element::Material m{"fiber", 0.0, 0.0, 1.0, {}};
  m.orthotropic = element::Orthotropic{E, nu, G, {}};
  return m;
}

element::Material carbon() {
  return fiber({181e3, 10.3e3, 10.3e3}, {0.28, 0.28, 0.4},
               {7.17e3, 7.17e3, 3e3});
}

/// A B, B D of a laminate of thickness t.
Six6 whole_stiffness_of(const Laminate& laminate, double t) {
  const LaminateStiffness s = laminate_stiffness(laminate_law(laminate), t);
  Six6 all;
  all << s.A, s.B, s.B, s.D;
  return all;
}

// Forces and moments on the edges of a plate of any laminate, cut as it comes:
// the strains and curvatures of classical lamination theory, displacements
// and rotations to rounding, with stresses ply by ply.
TEST(LaminatedShell, PlatesUnderEdgeLoadsAreThoseOfLaminationTheory) {
  constexpr double kA = 3.0;
  constexpr double kB = 2.0;
  constexpr double kThickness = 0.2;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int k = 0; k < 6; ++k) {
    MappedShell shell = shell_shapes::mapped_shell(
        [](double s, double t) -> Vec3 {
          return {kA * s, kB * t, 0.0};
        },
        kThickness, {.m = 3, .n = 3, .cut = Cut::Mixed, .shake = 0.2});
    Section section;
    for (int p = 0; p < 1 + k; ++p) {
      section.laminate.plies.push_back(
          {carbon(), 1.5 + draw(random), 3.0 * draw(random)});
    }
    section.direction = Vec3(1.0, 0.0, 0.3);
    const std::vector<Section> sections = {section};
    Eigen::Matrix<double, 6, 1> loads;
    for (int i = 0; i < 6; ++i) {
      loads[i] = (i < 3 ? 100.0 : 5.0) * draw(random);
    }
    const auto [N1, N2, N12] = std::array{loads[0], loads[1], loads[2]};
    const auto [M1, M2, M12] = std::array{loads[3], loads[4], loads[5]};
    ShellLoads acting;
    const auto edge = [&](double sign, const Vec3& force, const Vec3& moment,
                          const auto& where) {
      for (const auto& e : shell.edges(where)) {
        acting.edges.push_back({e, sign * force, sign * moment});
      }
    };
    const Vec3 on_x(N1, N12, 0.0);
    const Vec3 turn_x(-M12, M1, 0.0);
    const Vec3 on_y(N12, N2, 0.0);
    const Vec3 turn_y(-M2, M12, 0.0);
    edge(1.0, on_x, turn_x, [](double s, double) { return s > 1.0 - 1e-9; });
    edge(-1.0, on_x, turn_x, [](double s, double) { return s < 1e-9; });
    edge(1.0, on_y, turn_y, [](double, double t) { return t > 1.0 - 1e-9; });
    edge(-1.0, on_y, turn_y, [](double, double t) { return t < 1e-9; });
    std::vector<NodeSupport> supports;
    shell_shapes::hold(supports, {shell.node(0.0, 0.0)}, "xyzabc");
    const ShellSystem system(shell.mesh, sections, supports);
    const VectorX u = system.solve(acting).displacement;
    const Eigen::Matrix<double, 6, 1> e =
        whole_stiffness_of(section.laminate, kThickness).inverse() * loads;
    double size = 0.0;
    double error = 0.0;
    for (std::size_t n = 0; n < shell.mesh.nodes.size(); ++n) {
      const double x = shell.mesh.nodes[n].x();
      const double y = shell.mesh.nodes[n].y();
      Six exact;
      exact << e[0] * x + 0.5 * e[2] * y, e[1] * y + 0.5 * e[2] * x,
          -0.5 * (e[3] * x * x + e[4] * y * y + e[5] * x * y),
          -e[4] * y - 0.5 * e[5] * x, e[3] * x + 0.5 * e[5] * y, 0.0;
      const Six found = u.segment<6>(6L * static_cast<int>(n));
      size = std::max(size, exact.lpNorm<Eigen::Infinity>());
      error = std::max(error, (found - exact).lpNorm<Eigen::Infinity>());
    }
    EXPECT_LT(error, 1e-8 * size) << section.laminate.plies.size() << " plies";
    // Stress of each ply, at its own height.
    const LaminateLaw law = laminate_law(section.laminate);
    visit_ply_stresses(
        shell.mesh, sections, acting, u,
        [&](int ply, const std::vector<FacetStress>& stress) {
          const auto expect = [&](double at, const element::Stress& found) {
            const Vec3 s = law.plies[ply].plane *
                           (e.head<3>() + at * kThickness * e.tail<3>());
            const double scale = 1e-6 * std::max(1.0, s.norm());
            EXPECT_NEAR(found[0], s[0], scale);
            EXPECT_NEAR(found[1], s[1], scale);
            EXPECT_NEAR(found[3], s[2], scale);
          };
          for (const FacetStress& facet : stress) {
            expect(law.from[ply], facet[0].negative);
            expect(0.5 * (law.from[ply] + law.to[ply]), facet[4].middle);
            expect(law.to[ply], facet[2].positive);
          }
        });
  }
}

// NAFEMS R0031/1 (Hardy, Composite benchmarks, 2001): seven plies over two
// supports, 683.9 MPa below, -1.06 mm.
TEST(LaminatedShell, BendsAsNafemsSays) {
  constexpr double kLength = 50.0;
  MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {kLength * s, 10.0 * t, 0.0};
      },
      1.0, {.m = 20, .n = 4});
  const element::Material m =
      fiber({100e3, 5e3, 5e3}, {0.4, 0.3, 0.3}, {3e3, 3e3, 2e3});
  Section section;
  const double across = 0.5 * std::numbers::pi;
  section.laminate.plies = {
      {m, 0.1, 0.0}, {m, 0.1, across}, {m, 0.1, 0.0}, {m, 0.4, across},
      {m, 0.1, 0.0}, {m, 0.1, across}, {m, 0.1, 0.0}};
  section.direction = Vec3::UnitX();
  const std::vector<Section> sections = {section};
  std::vector<NodeSupport> supports;
  const auto at = [](double x) {
    return [x](double s, double) { return std::abs(kLength * s - x) < 1e-6; };
  };
  shell_shapes::hold(supports, shell.nodes(at(10.0)), "z");
  shell_shapes::hold(supports, shell.nodes(at(40.0)), "z");
  shell_shapes::hold(supports, {shell.node(0.5, 0.5)}, "xyc");
  ShellLoads loads;
  for (const auto& edge : shell.edges(at(25.0))) {
    // Both facets at an edge name it.
    loads.edges.push_back({edge, {0.0, 0.0, -5.0}, Vec3::Zero()});
  }
  const ShellSystem system(shell.mesh, sections, supports);
  const VectorX u = system.solve(loads).displacement;
  const int middle = shell.node(0.5, 0.5);
  EXPECT_NEAR(u[6L * middle + 2], -1.06, 0.015);
  double largest = 0.0;
  for (const FacetStress& facet : averaged_stress(
           shell.mesh, shell_stress(shell.mesh, sections, loads, u))) {
    for (const WallStress& wall : facet) {
      largest = std::max(largest, wall.negative[0]);
    }
  }
  EXPECT_NEAR(largest, 683.9, 0.03 * 683.9);
}

// NAFEMS R0031/3: a square sandwich, hinged all around, under pressure:
// -0.123 in, 34.45 and 13.93 ksi in a face.
TEST(LaminatedShell, ASandwichBendsAsNafemsSays) {
  constexpr double kSide = 10.0;
  MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {0.5 * kSide * s, 0.5 * kSide * t, 0.0};
      },
      0.806, {.m = 8, .n = 8});
  const element::Material face =
      fiber({10e6, 4e6, 4e6}, {0.3, 0.3, 0.3}, {1.875e6, 1.875e6, 1.875e6});
  const element::Material core =
      fiber({10.0, 10.0, 10.0}, {0.0, 0.0, 0.0}, {10.0, 3e4, 1.2e4});
  Section section;
  section.laminate.plies = {{face, 0.028}, {core, 0.75}, {face, 0.028}};
  section.direction = Vec3::UnitX();
  const std::vector<Section> sections = {section};
  std::vector<NodeSupport> supports;
  shell_shapes::hold(
      supports, shell.nodes([](double s, double) { return s < 1e-9; }), "xb");
  shell_shapes::hold(
      supports, shell.nodes([](double, double t) { return t < 1e-9; }), "ya");
  shell_shapes::hold(
      supports, shell.nodes([](double s, double) { return s > 1.0 - 1e-9; }),
      "yza");
  shell_shapes::hold(
      supports, shell.nodes([](double, double t) { return t > 1.0 - 1e-9; }),
      "xzb");
  ShellLoads loads;
  for (int f = 0; f < static_cast<int>(shell.mesh.facets.size()); ++f) {
    loads.pressures.push_back({f, -100.0, WallSide::Middle});
  }
  const ShellSystem system(shell.mesh, sections, supports);
  const VectorX u = system.solve(loads).displacement;
  const int middle = shell.node(0.0, 0.0);
  EXPECT_NEAR(u[6L * middle + 2], -0.123, 0.0025);
  double first = 0.0;
  double second = 0.0;
  visit_ply_stresses(shell.mesh, sections, loads, u,
                     [&](int ply, const std::vector<FacetStress>& stress) {
                       const auto mean = averaged_stress(shell.mesh, stress);
                       for (std::size_t f = 0; f < mean.size() && ply == 0;
                            ++f) {
                         for (std::size_t i = 0; i < mean[f].size(); ++i) {
                           if (shell.mesh.facets[f][i] == middle) {
                             first = mean[f][i].middle[0];
                             second = mean[f][i].middle[1];
                           }
                         }
                       }
                     });
  EXPECT_NEAR(first, 34.45e3, 0.01 * 34.45e3);
  EXPECT_NEAR(second, 13.93e3, 0.04 * 13.93e3);
}

// A tube of one angle, pulled: it twists by a_16 N / r, and stretches by
// a_11 N, wherever the pull is even.
TEST(LaminatedShell, AnAnglePlyTubeTwistsAsItIsPulled) {
  constexpr double kRadius = 20.0;
  constexpr double kLength = 40.0;
  constexpr double kThickness = 0.1;
  constexpr double kAngle = 0.5;
  const auto half = [](double from) {
    return shell_shapes::mapped_shell(
        [from](double s, double t) -> Vec3 {
          const double a = std::numbers::pi * (from + s);
          return {kRadius * std::cos(a), kRadius * std::sin(a), kLength * t};
        },
        kThickness, {.m = 8, .n = 8});
  };
  const MappedShell shell = shell_shapes::joined(half(0.0), half(1.0));
  Section section;
  section.laminate.plies = {{carbon(), 1.0, kAngle}};
  section.direction = Vec3::UnitZ();
  const std::vector<Section> sections = {section};
  ShellLoads loads;
  const double N = 3.0;
  for (const auto& edge :
       shell.edges([](double, double t) { return t > 1.0 - 1e-9; })) {
    loads.edges.push_back({edge, {0.0, 0.0, N}, Vec3::Zero()});
  }
  for (const auto& edge :
       shell.edges([](double, double t) { return t < 1e-9; })) {
    loads.edges.push_back({edge, {0.0, 0.0, -N}, Vec3::Zero()});
  }
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports, {shell.node(0.0, 0.5)}, "xyzabc");
  const ShellSystem system(shell.mesh, sections, supports);
  const VectorX u = system.solve(loads).displacement;
  const Mat3 a = laminate_stiffness(laminate_law(section.laminate), kThickness)
                     .A.inverse();
  // Of two rings about the middle, means of what goes up and around.
  const auto ring = [&](double t) {
    double up = 0.0;
    double around = 0.0;
    double count = 0.0;
    for (const int n : shell.nodes(
             [t](double, double at) { return std::abs(at - t) < 1e-6; })) {
      const Vec3& x = shell.mesh.nodes[n];
      const Vec3 v = u.segment<3>(6L * n);
      up += v.z();
      around += Vec3::UnitZ().cross(x).dot(v) / kRadius;
      count += 1.0;
    }
    return std::pair(up / count, around / count);
  };
  const auto [up_1, around_1] = ring(0.25);
  const auto [up_2, around_2] = ring(0.75);
  const double apart = 0.5 * kLength;
  EXPECT_NEAR((up_2 - up_1) / (apart * a(0, 0) * N), 1.0, 1e-2);
  // The second axis, n x the first, lies against the way around.
  EXPECT_NEAR((around_2 - around_1) / (-apart * a(0, 2) * N), 1.0, 1e-2);
}

}  // namespace
}  // namespace meniscus::laminated_shell_test
