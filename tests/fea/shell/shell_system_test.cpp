#include "fea/shell/shell_system.h"

#include <cmath>
#include <limits>
#include <omp.h>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/shell/shell_stress.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_system_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::hold;
using shell_shapes::isotropic;
using shell_shapes::MappedShell;

/// A flat rectangle from a corner along two sides.
MappedShell rectangle(const Vec3& corner, const Vec3& along, const Vec3& up,
                      double t, int m, int n) {
  return shell_shapes::mapped_shell(
      [=](double s, double r) -> Vec3 { return corner + s * along + r * up; },
      t, {.m = m, .n = n, .cut = Cut::Mixed});
}

std::vector<int> nodes_where(const ShellMesh& mesh,
                             const std::function<bool(const Vec3&)>& where) {
  std::vector<int> found;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (where(mesh.nodes[i])) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

/// A force shared by an edge of a mapped shell that is the first of a joined
/// one or stands alone.
ShellLoads edge_force(const MappedShell& shell, const Vec3& per_length,
                      const std::function<bool(const Vec3&)>& where) {
  ShellLoads loads;
  for (const auto& f : shell.mesh.facets) {
    for (int e = 0; e < 3; ++e) {
      const std::array<int, 3> edge = {f[e], f[(e + 1) % 3], f[3 + e]};
      if (where(shell.mesh.nodes[edge[0]]) &&
          where(shell.mesh.nodes[edge[1]]) &&
          where(shell.mesh.nodes[edge[2]])) {
        loads.edges.push_back({edge, per_length});
      }
    }
  }
  return loads;
}

constexpr double kYoung = 2e5;

/// A strip bent up by a right angle, without contraction: two beams that meet
/// in a stiff corner.
TEST(ShellSystem, AFoldCarriesMoments) {
  constexpr double kCubic = 3e-3;  // of eight elements along each beam
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(0.6, 1.8);
  for (int draw = 0; draw < 4; ++draw) {
    const double a = 3.0 * number(random);
    const double h = 3.0 * number(random);
    const double b = number(random);
    const double t = 0.1 * number(random);
    const MappedShell shell = shell_shapes::joined(
        rectangle({0, 0, 0}, {a, 0, 0}, {0, b, 0}, t, 8, 2),
        rectangle({a, 0, 0}, {0, b, 0}, {0, 0, h}, t, 2, 8));
    std::vector<NodeSupport> supports;
    hold(supports,
         nodes_where(shell.mesh, [](const Vec3& x) { return x[0] < 1e-9; }),
         "xyzabc");
    const double P = 3.0;
    const auto tip = [&](const Vec3& x) { return x[2] > h - 1e-9; };
    const std::vector<Section> sections = {isotropic(kYoung, 0.0)};
    const ShellSystem system(shell.mesh, sections, supports);
    const VectorX u =
        system.solve(edge_force(shell, {P / b, 0, 0}, tip)).displacement;
    const double A = b * t;
    const double EI = kYoung * A * t * t / 12.0;
    const double beams = P * std::pow(h, 3) / (3 * EI) + P * h * h * a / EI +
                         P * a / (kYoung * A) +
                         P * h / (5.0 / 6.0 * 0.5 * kYoung * A);
    const int node = nodes_where(shell.mesh, tip).front();
    EXPECT_NEAR(u[6L * node] / beams, 1.0, kCubic);
    const double drop = -P * h * a * a / (2.0 * EI);
    EXPECT_NEAR(u[6L * node + 2] / drop, 1.0, kCubic);
  }
}

/// Three walls at one line: a slender T bends about its own middle.
TEST(ShellSystem, ATeeBendsAsABeam) {
  constexpr double kBeam = 5e-3;  // shear and section of a beam, 1/20 slender
  const double L = 20.0;
  const double b = 1.0;
  const double h = 0.8;
  const double t = 0.05;
  const MappedShell flange = shell_shapes::joined(
      rectangle({0, -0.5 * b, 0}, {L, 0, 0}, {0, 0.5 * b, 0}, t, 16, 2),
      rectangle({0, 0, 0}, {L, 0, 0}, {0, 0.5 * b, 0}, t, 16, 2));
  const MappedShell shell = shell_shapes::joined(
      flange, rectangle({0, 0, 0}, {L, 0, 0}, {0, 0, -h}, t, 16, 2));
  std::vector<NodeSupport> supports;
  hold(supports,
       nodes_where(shell.mesh, [](const Vec3& x) { return x[0] < 1e-9; }),
       "xyzabc");
  const double P = 1.0;
  const auto tip = [&](const Vec3& x) {
    return x[0] > L - 1e-9 && std::abs(x[1]) < 1e-9;
  };
  const std::vector<Section> sections = {isotropic(kYoung, 0.0)};
  const ShellSystem system(shell.mesh, sections, supports);
  const VectorX u =
      system.solve(edge_force(shell, {0, 0, -P / h}, tip)).displacement;
  const double low = 0.5 * h * h / (b + h);  // center under the flange
  const double I = t * (b * low * low + std::pow(h, 3) / 12.0 +
                        h * std::pow(0.5 * h - low, 2)) +
                   b * t * t * t / 12.0;
  const double bending = P * std::pow(L, 3) / (3.0 * kYoung * I);
  const double shear = P * L / (0.5 * kYoung * h * t * 0.85);
  const int node = nodes_where(shell.mesh, tip).front();
  EXPECT_NEAR(-u[6L * node + 2] / (bending + shear), 1.0, kBeam);
}

MappedShell barrel() {
  return shell_shapes::mapped_shell(
      [](double s, double r) -> Vec3 {
        return {std::cos(s), std::sin(s) * (1.0 + 0.2 * r * r), 1.5 * r};
      },
      0.05, {.m = 5, .n = 4, .cut = Cut::Mixed, .shake = 0.2});
}

/// Turning everything turns the answer; supports along their own axes.
TEST(ShellSystem, SupportsHoldAlongTheirAxes) {
  const Mat3 R =
      Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
  const auto solve = [&](const Mat3& Q) {
    MappedShell shell = barrel();
    for (Vec3& x : shell.mesh.nodes) {
      x = Q * x;
    }
    std::vector<NodeSupport> supports;
    hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
         "xyac");
    hold(supports, shell.nodes([](double, double r) { return r < 1e-9; }),
         "zb");
    for (NodeSupport& support : supports) {
      support.axes = element::LocalAxes{Q.col(0), Q.col(1)};
      support.value[2] = support.held[2] ? 0.01 : 0.0;
    }
    ShellLoads loads;
    loads.gravity = Q * Vec3(0, 0, -1);
    for (int f = 0; f < 10; ++f) {
      loads.pressures.push_back({f, 2.0, WallSide::Positive});
    }
    return ShellSystem(shell.mesh, sections, supports)
        .solve(loads)
        .displacement;
  };
  const VectorX here = solve(Mat3::Identity());
  const VectorX there = solve(R);
  double far = 0.0;
  for (Eigen::Index k = 0; k < here.size(); k += 3) {
    far = std::max(far, (there.segment<3>(k) - R * here.segment<3>(k)).norm());
  }
  EXPECT_LT(far, 1e-9 * here.lpNorm<Eigen::Infinity>());
}

TEST(ShellSystem, ReactionsBalanceTheLoads) {
  const MappedShell shell = barrel();
  const std::vector<Section> sections = {isotropic(kYoung, 0.3, 4.0)};
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
       "xyzc");
  ShellLoads loads;
  loads.gravity = {1, 2, 3};
  loads.pressures = {{3, 5.0}};
  const ShellSystem system(shell.mesh, sections, supports);
  const ShellSolution solution = system.solve(loads);
  const VectorX all =
      solution.reaction + nodal_forces(shell.mesh, sections, loads);
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    force += all.segment<3>(at);
    moment += shell.mesh.nodes[i].cross(Vec3(all.segment<3>(at))) +
              all.segment<3>(at + 3);
  }
  const double size = solution.reaction.lpNorm<1>();
  EXPECT_LT(force.norm(), 1e-10 * size);
  EXPECT_LT(moment.norm(), 1e-10 * size);
  // Forces only where something holds.
  const int free = shell.node(1, 1);
  EXPECT_LT(solution.reaction.segment<6>(6L * free).norm(), 1e-10 * size);
  EXPECT_NEAR(
      0.5 *
          solution.displacement.dot(nodal_forces(shell.mesh, sections, loads)) /
          solution.strain_energy,
      1.0, 1e-9);
}

TEST(ShellSystem, SolvesSeveralLoadsWithItsFactor) {
  const MappedShell shell = barrel();
  const std::vector<Section> sections = {isotropic(kYoung, 0.3, 4.0)};
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
       "xyzabc");
  supports.front().value[1] = 0.02;  // the same for all of them
  std::vector<ShellLoads> loads(3);
  loads[0].gravity = {1, 2, 3};
  loads[1].pressures = {{3, 5.0}, {4, -2.0}};
  loads[2].temperature = WallTemperature{.mean = 30.0, .across = 12.0};
  for (const int levels : {0, 2}) {
    const ShellFactorOptions options = {
        .unknowns = 100, .most_levels = levels, .kept_bytes = 0.0};
    const ShellSystem system(shell.mesh, sections, supports, facet_rule(),
                             options, {}, {}, loads);
    ASSERT_EQ(system.solutions().size(), loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const ShellSolution& found = system.solutions()[k];
      const ShellSolution alone = system.solve(loads[k]);
      EXPECT_LT((found.displacement - alone.displacement).norm(),
                1e-10 * alone.displacement.norm());
      EXPECT_LT((found.reaction - alone.reaction).norm(),
                1e-10 * alone.reaction.norm());
      EXPECT_NEAR(found.strain_energy / alone.strain_energy, 1.0, 1e-9);
    }
  }
}

/// Corners in any order, normals either way: the same wall.
TEST(ShellSystem, FacetsMayBeNumberedAnyWay) {
  const MappedShell shell = barrel();
  const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
       "xyzabc");
  ShellLoads loads;
  loads.nodal = VectorX::LinSpaced(
      static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()), -1.0, 2.0);
  ShellMesh turned = shell.mesh;
  for (std::size_t f = 0; f < turned.facets.size(); ++f) {
    auto& n = turned.facets[f];
    if (f % 3 == 1) {
      n = {n[1], n[2], n[0], n[4], n[5], n[3]};
    } else if (f % 3 == 2) {
      n = {n[1], n[0], n[2], n[3], n[5], n[4]};
    }
  }
  const VectorX one =
      ShellSystem(shell.mesh, sections, supports).solve(loads).displacement;
  const VectorX other =
      ShellSystem(turned, sections, supports).solve(loads).displacement;
  EXPECT_LT((one - other).norm(), 1e-9 * one.norm());
}

TEST(ShellSystem, SameBitsForAnyNumberOfThreads) {
  const MappedShell shell = barrel();
  const std::vector<Section> sections = {isotropic(kYoung, 0.3, 4.0)};
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
       "xyzabc");
  ShellLoads loads;
  loads.gravity = {1, 2, 3};
  const int threads = omp_get_max_threads();
  std::vector<VectorX> answers;
  std::vector<double> stresses;
  for (const int count : {1, 3}) {
    omp_set_num_threads(count);
    const ShellSystem system(shell.mesh, sections, supports);
    answers.push_back(system.solve(loads).displacement);
    stresses.push_back(
        shell_stress(shell.mesh, sections, loads, answers.back())[7][2]
            .positive[1]);
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(stresses[0], stresses[1]);
}

/// What a surface's own edges and mid-sides make.
TEST(ShellMesh, IsMadeOfASurface) {
  QuadraticSurface surface;
  surface.base.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  surface.base.facets = {{0, 1, 2}, {0, 2, 3}};
  list_edges(surface.base.facets, surface.edges, surface.facet_edges);
  for (const Edge& e : surface.edges) {
    surface.mid.push_back(
        0.5 * (surface.base.points[e[0]] + surface.base.points[e[1]]));
  }
  const ShellMesh mesh = shell_mesh(surface, VectorX::LinSpaced(4, 0.1, 0.4));
  ASSERT_EQ(mesh.facets.size(), 2U);
  ASSERT_EQ(mesh.nodes.size(), 9U);
  check_shell(mesh, {isotropic(1.0, 0.3)});
  for (std::size_t f = 0; f < 2; ++f) {
    for (int e = 0; e < 3; ++e) {
      const auto& n = mesh.facets[f];
      EXPECT_EQ(mesh.nodes[n[3 + e]],
                0.5 * (mesh.nodes[n[e]] + mesh.nodes[n[(e + 1) % 3]]));
    }
  }
  EXPECT_NEAR(mesh.thickness[1][2], 0.4, 1e-15);
  EXPECT_THROW(shell_mesh(surface, VectorX::Ones(3)), MeshError);
}

TEST(ShellMesh, RefusesWhatIsNoShell) {
  const MappedShell shell =
      rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1, 1, 1);
  const std::vector<Section> sections = {isotropic(1.0, 0.3)};
  const auto refused = [&](const std::function<void(ShellMesh&)>& spoil,
                           const char* message, std::vector<Section> with) {
    ShellMesh mesh = shell.mesh;
    spoil(mesh);
    try {
      check_shell(mesh, with);
      ADD_FAILURE() << message;
    } catch (const MeshError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(message));
    }
  };
  refused([](ShellMesh& m) { m.thickness[1][2] = 0.0; }, "thickness", sections);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  refused([](ShellMesh& m) { m.thickness[0][1] = kNone; }, "thickness",
          sections);
  refused([](ShellMesh& m) { m.nodes[2][1] = kNone; }, "folded", sections);
  refused([](ShellMesh& m) { m.facets[0][4] = 99; }, "node 99", sections);
  refused([](ShellMesh& m) { m.section[1] = 1; }, "section 1", sections);
  refused([](ShellMesh& m) { m.nodes.emplace_back(0, 0, 0); }, "no facet",
          sections);
  refused([](ShellMesh& m) { std::swap(m.facets[0][3], m.facets[0][4]); },
          "folded", sections);
  std::vector<Section> across = sections;
  across[0].direction = Vec3(0, 0, 2);
  refused([](ShellMesh&) {}, "direction", across);
}

void expect_free(const ShellMesh& mesh,
                 const std::vector<NodeSupport>& supports, const char* motion) {
  const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
  try {
    const ShellSystem system(mesh, sections, supports);
    ADD_FAILURE() << motion;
  } catch (const SolverError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(motion));
  }
}

/// Springs at a corner and between it and a node of its facet alone hold it.
TEST(ShellSystem, SpringsToTheGroundHoldIt) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {2.0 * s, t, 0.3 * s * t};
      },
      0.1, {.m = 3, .n = 2});
  const std::vector<Section> sections = {shell_shapes::isotropic(50.0, 0.3)};
  std::vector<GroundSpring> springs;
  for (const auto& [s, t] :
       {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(0.0, 1.0)}) {
    const int node = shell.node(s, t);
    springs.push_back({node, node, Vec3(1.0, 2.0, 3.0).asDiagonal()});
  }
  const std::array<int, 6>& facet = shell.mesh.facets.front();
  Mat3 between;
  between << 0.2, 0.1, 0.0, -0.05, 0.3, 0.02, 0.0, 0.04, 0.1;
  springs.push_back({facet[1], facet[3], between});
  const ShellSystem system(shell.mesh, sections, {}, facet_rule(), {}, springs);
  ShellLoads loads;
  loads.nodal = VectorX::Zero(std::ssize(shell.mesh.nodes) * 6);
  loads.nodal[6L * shell.node(1.0, 1.0) + 2] = 0.5;
  const VectorX u = system.solve(loads).displacement;
  VectorX pull = -(ShellStiffness(shell.mesh, sections).times(u) - loads.nodal);
  for (const GroundSpring& spring : springs) {
    const Eigen::Index at = 6L * spring.at;
    const Eigen::Index from = 6L * spring.from;
    pull.segment<3>(at) -= spring.block * u.segment<3>(from);
    if (at != from) {
      pull.segment<3>(from) -= spring.block.transpose() * u.segment<3>(at);
    }
  }
  EXPECT_LT(pull.norm(), 1e-11);
  springs.resize(2);  // it turns about the line of both
  EXPECT_THROW(ShellSystem(shell.mesh, sections, {}, facet_rule(), {}, springs),
               SolverError);
  springs.push_back({0, 1000, Mat3::Identity()});
  EXPECT_THROW(ShellSystem(shell.mesh, sections, {}, facet_rule(), {}, springs),
               InvalidInput);
}

TEST(ShellSystem, RefusesWhatIsFreeToMove) {
  const MappedShell shell = barrel();
  const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
  const auto side = shell.nodes([](double s, double) { return s < 1e-9; });
  std::vector<NodeSupport> supports;
  hold(supports, side, "xyc");
  expect_free(shell.mesh, supports, "move along");
  supports.clear();
  hold(supports, side, "xyz");  // a hinge along z
  expect_free(shell.mesh, supports, "turn about");
  expect_free(shell.mesh, {}, "free to");
  // A piece for itself, beside one that is held.
  const MappedShell two = shell_shapes::joined(
      rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.1, 2, 2),
      rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 0.1, 2, 2));
  supports.clear();
  hold(supports,
       nodes_where(two.mesh,
                   [](const Vec3& x) { return x[0] < 1e-9 && x[2] < 0.5; }),
       "xyzabc");
  expect_free(two.mesh, supports, "around (0.5, 0.5, 1)");
  supports = {{.node = 1000}};
  EXPECT_THROW(ShellSystem(shell.mesh, sections, supports), InvalidInput);
  supports = {{.node = 1, .held = {true}, .value = Six::Ones()},
              {.node = 1, .held = {true}}};
  EXPECT_THROW(ShellSystem(shell.mesh, sections, supports), InvalidInput);
  supports = {{.node = 1, .axes = element::LocalAxes{{0, 1, 0}, {1, 0, 0}}},
              {.node = 1, .held = {true}}};
  EXPECT_THROW(ShellSystem(shell.mesh, sections, supports), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_system_test
