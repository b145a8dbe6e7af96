/// Layered walls, and walls beside their surface, against closed forms.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/math/dense.h"
#include "fea/shell/shell_system.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_walls_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::hold;
using shell_shapes::MappedShell;

constexpr double kPi = std::numbers::pi;

/// Middle of a rectangle a x b of crossed plies on supports that let it slide
/// along its edges' normals, under q cos cos about the middle: Navier's form
/// with transverse shear (Reddy, Mechanics of laminated composite plates, 2004,
/// 6.3): u = U sin cos, v = V cos sin, w = W cos cos, rotations alike.
double crossed_plate(const LaminateStiffness& s, double a, double b) {
  const double x = kPi / a;
  const double y = kPi / b;
  // Strains xx, yy, xy and curvatures by U, V, W, Rx, Ry (the normal moves by
  // zeta R), shears xz, yz.
  Eigen::Matrix<double, 3, 5> e = Eigen::Matrix<double, 3, 5>::Zero();
  e(0, 0) = x;
  e(1, 1) = y;
  e(2, 0) = -y;
  e(2, 1) = -x;
  Eigen::Matrix<double, 3, 5> k = Eigen::Matrix<double, 3, 5>::Zero();
  k(0, 3) = x;
  k(1, 4) = y;
  k(2, 3) = -y;
  k(2, 4) = -x;
  Eigen::Matrix<double, 2, 5> g = Eigen::Matrix<double, 2, 5>::Zero();
  g(0, 2) = -x;
  g(0, 3) = 1.0;
  g(1, 2) = -y;
  g(1, 4) = 1.0;
  const Eigen::MatrixXd K = e.transpose() * s.A * e + e.transpose() * s.B * k +
                            k.transpose() * s.B * e + k.transpose() * s.D * k +
                            g.transpose() * s.S * g;
  const VectorX load = VectorX::Unit(5, 2);
  return solve_ldlt(K, load)[2];
}

TEST(ShellWalls, CrossedPliesBendAsNavierSays) {
  constexpr double kEightCells = 2e-3;
  std::mt19937 random(23);
  std::uniform_real_distribution<double> number(0.6, 1.7);
  for (int draw = 0; draw < 4; ++draw) {
    const double a = number(random);
    const double b = number(random);
    const double t = 0.06 * number(random);
    element::Material fiber{"fiber", 1.0, 0.3, 1.0, {}};
    fiber.orthotropic = element::Orthotropic{{25.0 * number(random), 1.0, 1.0},
                                             {0.25, 0.25, 0.3},
                                             {0.5 * number(random), 0.5, 0.2},
                                             {}};
    Section section;
    section.laminate.plies = {{fiber, number(random), 0.0},
                              {fiber, number(random), 0.5 * kPi}};
    section.direction = Vec3(2.0, 0.0, 0.7);
    const std::vector<Section> sections = {section};
    const MappedShell shell = shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          return {0.5 * a * s, 0.5 * b * r, 0.0};
        },
        t, {.m = 8, .n = 8, .cut = Cut::Mixed, .shake = 0.15});
    std::vector<NodeSupport> supports;
    hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
         "xbc");
    hold(supports, shell.nodes([](double, double r) { return r < 1e-9; }),
         "yac");
    hold(supports, shell.nodes([](double s, double) { return s > 1 - 1e-9; }),
         "yza");
    hold(supports, shell.nodes([](double, double r) { return r > 1 - 1e-9; }),
         "xzb");
    // The load as its interpolation: consistent forces of nodal pressures.
    ShellLoads loads;
    loads.nodal =
        VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
    for (const auto& f : shell.mesh.facets) {
      const Vec3& o = shell.mesh.nodes[f[0]];
      const double twice =
          (shell.mesh.nodes[f[1]] - o).cross(shell.mesh.nodes[f[2]] - o).norm();
      for (const FacetPoint& p : facet_rule()) {
        Vec3 x = Vec3::Zero();
        for (int i = 0; i < kNodes; ++i) {
          x += p.shape[i] * shell.mesh.nodes[f[i]];
        }
        const double q = std::cos(kPi * x[0] / a) * std::cos(kPi * x[1] / b);
        for (int i = 0; i < kNodes; ++i) {
          loads.nodal[6L * f[i] + 2] += p.weight * twice * q * p.shape[i];
        }
      }
    }
    const ShellSystem system(shell.mesh, sections, supports);
    const double w =
        system.solve(loads).displacement[6L * shell.node(0, 0) + 2];
    const double exact = crossed_plate(
        laminate_stiffness(laminate_law(section.laminate), t), a, b);
    EXPECT_NEAR(w / exact, 1.0, kEightCells);
  }
}

/// A quarter of a thick tube that bends, drawn at its middle, inside and
/// outside: one and the same wall.
TEST(ShellWalls, AnOffsetIsWhereTheSurfaceIs) {
  constexpr double kMesh = 1e-3;  // 16 cells, each of another surface
  constexpr double kT = 0.2;
  const auto deflection = [&](double offset) {
    const double R = 1.0 - offset * kT;  // normals point outwards
    const MappedShell shell = shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          const double a = 0.5 * kPi * s;
          return {R * std::cos(a), R * std::sin(a), 0.4 * r};
        },
        kT, {.m = 16, .n = 3, .cut = Cut::Mixed});
    std::vector<NodeSupport> supports;
    hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
         "xyzabc");
    std::vector<Section> sections = {shell_shapes::isotropic(1e3, 0.3, 2.0)};
    sections[0].offset = offset;
    ShellLoads loads;
    loads.gravity = {1.0, 0.3, 0.2};
    const ShellSystem system(shell.mesh, sections, supports);
    const VectorX u = system.solve(loads).displacement;
    // Of the middle of the wall, at the free end.
    const Six end = u.segment<6>(6L * shell.node(1.0, 0.0));
    const Vec3 arm(0.0, offset * kT, 0.0);
    return Vec3(end.head<3>() + Vec3(end.tail<3>()).cross(arm));
  };
  const Vec3 middle = deflection(0.0);
  for (const double offset : {-0.5, 0.5, 0.2}) {
    EXPECT_LT((deflection(offset) - middle).norm() / middle.norm(), kMesh);
  }
}

/// The length of a wall whose thickness runs linearly: its ends' log over the
/// difference.
TEST(ShellWalls, ThicknessRunsBetweenCorners) {
  constexpr double kMesh = 1e-4;
  MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double r) -> Vec3 {
        return {3.0 * s, r, 0.0};
      },
      1.0, {.m = 12, .n = 2, .cut = Cut::Mixed, .shake = 0.2});
  for (std::size_t f = 0; f < shell.mesh.facets.size(); ++f) {
    for (int c = 0; c < 3; ++c) {
      shell.mesh.thickness[f][c] =
          0.1 * (1.0 + shell.place[shell.mesh.facets[f][c]][0]);
    }
  }
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
       "xyzabc");
  ShellLoads loads;
  for (const auto& e :
       shell.edges([](double s, double) { return s > 1.0 - 1e-9; })) {
    loads.edges.push_back({e, {2.0, 0, 0}});
  }
  const std::vector<Section> sections = {shell_shapes::isotropic(50.0, 0.0)};
  const ShellSystem system(shell.mesh, sections, supports);
  const double u = system.solve(loads).displacement[6L * shell.node(1, 0.5)];
  EXPECT_NEAR(u / (2.0 * 3.0 * std::log(2.0) / (50.0 * 0.1)), 1.0, kMesh);
}

}  // namespace
}  // namespace meniscus::shell_walls_test
