#include "fea/shell/rigid_rims.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_system.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::rigid_rims_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::hold;
using shell_shapes::isotropic;
using shell_shapes::MappedShell;

constexpr double kYoung = 2e5;
constexpr std::array<bool, 6> kAll = {true, true, true, true, true, true};

RigidRim rim_of(const ShellMesh& mesh, const std::vector<int>& nodes,
                const Vec3& point) {
  RigidRim rim{.name = "rim", .nodes = nodes, .point = point};
  for (const int node : nodes) {
    rim.places.push_back(mesh.nodes[node]);
  }
  return rim;
}

bool at_start(double s, double) { return s < 1e-9; }
bool at_end(double s, double) { return s > 1.0 - 1e-9; }

ShellSystem solved(const MappedShell& shell,
                   const std::vector<Section>& sections,
                   const std::vector<NodeSupport>& supports,
                   const std::vector<RigidRim>& rims,
                   const ShellFactorOptions& options = {}) {
  return {shell.mesh, sections, supports, facet_rule(), options, {}, rims};
}

/// A wavy strip that is thicker here and there.
MappedShell strip(unsigned seed, int cells = 6) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double bend = 0.3 * unit(random);
  const double twist = 0.4 * unit(random);
  MappedShell shell = shell_shapes::mapped_shell(
      [=](double s, double t) -> Vec3 {
        return {3.0 * s, t + 0.1 * s * t, bend * s * s + twist * s * t};
      },
      0.08,
      {.m = cells, .n = 4, .cut = Cut::Mixed, .shake = 0.2, .seed = seed});
  for (Vec3& t : shell.mesh.thickness) {
    t *= 1.0 + 0.3 * unit(random);
  }
  return shell;
}

/// 6 per node, none like the other.
VectorX scattered(const ShellMesh& mesh, double phase) {
  VectorX six(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (Eigen::Index k = 0; k < six.size(); ++k) {
    six[k] = std::sin(1.7 * static_cast<double>(k) + phase);
  }
  return six;
}

ShellLoads some_loads(const MappedShell& shell) {
  ShellLoads loads;
  loads.gravity = {1.0, 2.0, -3.0};
  for (int f = 0; f < 12; ++f) {
    loads.pressures.push_back({f, 0.3, WallSide::Positive});
  }
  loads.nodal = 0.1 * scattered(shell.mesh, 0.4);
  return loads;
}

VectorX rigid_motion(const Points& places, const Vec3& move, const Vec3& turn,
                     const Vec3& about) {
  VectorX six(static_cast<Eigen::Index>(6 * places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    six.segment<3>(at) = move + turn.cross(places[i] - about);
    six.segment<3>(at + 3) = turn;
  }
  return six;
}

TEST(RigidRims, HeldInAllAreClamps) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const MappedShell shell = strip(seed);
    const std::vector<Section> sections = {isotropic(kYoung, 0.3, 2.0)};
    const std::vector<int> nodes = shell.nodes(at_start);
    std::vector<NodeSupport> supports;
    hold(supports, nodes, "xyzabc");
    RigidRim rim = rim_of(shell.mesh, nodes, {0.3, -2.0, 5.0});
    rim.held = kAll;
    const ShellLoads loads = some_loads(shell);
    const ShellSolution clamped =
        solved(shell, sections, supports, {}).solve(loads);
    const ShellSolution held = solved(shell, sections, {}, {rim}).solve(loads);
    EXPECT_LT((held.displacement - clamped.displacement).norm(),
              1e-10 * clamped.displacement.norm());
    EXPECT_LT((held.reaction - clamped.reaction).norm(),
              1e-9 * clamped.reaction.norm());
    // Where supports hold its nodes as it does itself, they add nothing.
    const VectorX both =
        solved(shell, sections, supports, {rim}).solve(loads).displacement;
    EXPECT_TRUE(both == held.displacement);
  }
}

/// Along axes of its own, too.
TEST(RigidRims, HeldAtARigidMotionTakeTheShellAlong) {
  for (const unsigned seed : {4U, 5U}) {
    const MappedShell shell = strip(seed);
    const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
    const Vec3 point(1.0, 4.0, -2.0);
    RigidRim rim = rim_of(shell.mesh, shell.nodes(at_start), point);
    rim.held = kAll;
    rim.axes = element::LocalAxes{Vec3(1, 2, 3), Vec3(0, 1, -1)};
    rim.value << 0.3, -0.2, 0.5, 0.01, -0.03, 0.02;
    const Mat3 Q = element::unit_axes(*rim.axes);
    const VectorX exact =
        rigid_motion(shell.mesh.nodes, Q * rim.value.head<3>(),
                     Q * rim.value.tail<3>(), point);
    const ShellSolution found = solved(shell, sections, {}, {rim}).solve({});
    EXPECT_LT((found.displacement - exact).norm(), 1e-9 * exact.norm());
    const VectorX forces =
        VectorX(solved(shell, sections, {}, {rim}).stiffness_times(exact));
    EXPECT_LT(forces.norm(), 1e-11 * kYoung * exact.norm());
  }
}

/// Two plates apart, one held: the other hangs on a rigid body alone.
TEST(RigidRims, JoinPiecesAndMoveAsOne) {
  const auto plate = [](double x) {
    return shell_shapes::mapped_shell(
        [=](double s, double t) -> Vec3 {
          return {x + s, t, 0.1 * s * t};
        },
        0.05, {.m = 4, .n = 3, .cut = Cut::Mixed});
  };
  const MappedShell shell = shell_shapes::joined(plate(0.0), plate(3.0));
  const std::vector<Section> sections = {isotropic(kYoung, 0.3, 1.0)};
  std::vector<int> ends;
  std::vector<int> start;
  for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
    const double x = shell.mesh.nodes[i][0];
    if (std::abs(x - 1.0) < 1e-9 || std::abs(x - 3.0) < 1e-9) {
      ends.push_back(static_cast<int>(i));
    } else if (x < 1e-9) {
      start.push_back(static_cast<int>(i));
    }
  }
  std::vector<NodeSupport> supports;
  hold(supports, start, "xyzabc");
  const Vec3 point(2.0, 7.0, 1.0);
  const RigidRim rim = rim_of(shell.mesh, ends, point);
  EXPECT_THROW(solved(shell, sections, supports, {}), SolverError);
  const ShellSystem system = solved(shell, sections, supports, {rim});
  const ShellLoads loads = {.gravity = {0.3, 0.5, -9.0}};
  const ShellSolution solution = system.solve(loads);
  const VectorX u = solution.displacement;
  const Vec3 turn = u.segment<3>(6L * ends[0] + 3);
  const Vec3 move = u.segment<3>(6L * ends[0]) -
                    turn.cross(shell.mesh.nodes[ends[0]] - point);
  for (const int node : ends) {
    const Vec3 own = move + turn.cross(shell.mesh.nodes[node] - point);
    EXPECT_LT((u.segment<3>(6L * node) - own).norm(), 1e-12 * u.norm());
    EXPECT_LT((u.segment<3>(6L * node + 3) - turn).norm(), 1e-12 * u.norm());
  }
  // What the rim passes on balances; the supports bear the loads.
  const VectorX forces = nodal_forces(shell.mesh, sections, loads);
  Vec3 passed = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  Vec3 held = Vec3::Zero();
  for (const int node : ends) {
    const Vec3 force = solution.reaction.segment<3>(6L * node);
    passed += force;
    moment += shell.mesh.nodes[node].cross(force) +
              solution.reaction.segment<3>(6L * node + 3);
  }
  Vec3 all = Vec3::Zero();
  for (Eigen::Index k = 0; k < forces.size(); k += 6) {
    all += forces.segment<3>(k);
    held += solution.reaction.segment<3>(k);
  }
  EXPECT_LT(passed.norm(), 1e-8 * all.norm());
  EXPECT_LT(moment.norm(), 1e-7 * all.norm());
  EXPECT_LT((held + all).norm(), 1e-8 * all.norm());
}

MappedShell tube(double R, double L, double t, int around, int along) {
  const auto half = [&](double from) {
    return shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          const double phi = from + std::numbers::pi * r;
          return {R * std::cos(phi), R * std::sin(phi), L * s};
        },
        t, {.m = along, .n = around, .cut = Cut::Mixed});
  };
  return shell_shapes::joined(half(0.0), half(std::numbers::pi));
}

/// One twists it as T L / (G J), J = 2 pi R^3 t (1 + (t / 2 R)^2), where the
/// other end is clamped: rigid ends change nothing of pure torsion.
TEST(RigidRims, TwistATubeAsBredtSays) {
  const double R = 10.0;
  const double L = 30.0;
  const double t = 0.5;
  const double T = 1e4;
  const double G = kYoung / 2.6;
  const double J = 2.0 * std::numbers::pi * std::pow(R, 3) * t *
                   (1.0 + std::pow(0.5 * t / R, 2));
  const double exact = T * L / (G * J);
  std::vector<double> errors;
  for (const int cells : {3, 6, 12}) {
    const MappedShell shell = tube(R, L, t, cells, cells);
    std::vector<NodeSupport> supports;
    std::vector<int> end;
    for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
      const double z = shell.mesh.nodes[i][2];
      if (z < 1e-9) {
        hold(supports, {static_cast<int>(i)}, "xyzabc");
      } else if (z > L - 1e-9) {
        end.push_back(static_cast<int>(i));
      }
    }
    // One node of the rim takes all of the moment.
    ShellLoads loads;
    loads.nodal =
        VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
    loads.nodal[6L * end[1] + 5] = T;
    const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
    const VectorX u =
        solved(shell, sections, supports, {rim_of(shell.mesh, end, {5, 5, L})})
            .solve(loads)
            .displacement;
    errors.push_back(std::abs(u[6L * end[0] + 5] / exact - 1.0));
  }
  EXPECT_LT(errors[2], 2e-5);
  EXPECT_LT(errors[2], errors[1] / 4.0);
  EXPECT_LT(errors[1], errors[0] / 4.0);
}

/// A strip of nu = 0, clamped, its end rigid under a moment and a force at a
/// point beyond it: a beam, also where it is held from turning.
TEST(RigidRims, EndAStripAsABeam) {
  const double L = 4.0;
  const double b = 1.0;
  const double t = 0.1;
  const double beyond = 1.5;
  const double EI = kYoung * b * t * t * t / 12.0;
  const double GA = 5.0 / 6.0 * 0.5 * kYoung * b * t;
  const std::vector<Section> sections = {isotropic(kYoung, 0.0)};
  for (const bool guided : {false, true}) {
    const MappedShell shell = shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          return {L * s, b * r, 0.0};
        },
        t, {.m = 8, .n = 2, .cut = Cut::Mixed, .shake = 0.2});
    std::vector<NodeSupport> supports;
    hold(supports, shell.nodes(at_start), "xyzabc");
    const std::vector<int> end = shell.nodes(at_end);
    RigidRim rim = rim_of(shell.mesh, end, {L + beyond, 0.5 * b, 0.0});
    rim.held[4] = guided;
    const double P = 2.0;
    const double M = 3.0;
    ShellLoads loads;
    loads.nodal =
        VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
    const int node = end[2];
    const Vec3 arm = rim.point - shell.mesh.nodes[node];
    const Vec3 force(0, 0, P);
    loads.nodal.segment<3>(6L * node) = force;
    loads.nodal.segment<3>(6L * node + 3) = arm.cross(force) + Vec3(0, -M, 0);
    const VectorX u =
        solved(shell, sections, supports, {rim}).solve(loads).displacement;
    const double end_moment = P * beyond + M;
    const double turn = P * L * L / (2.0 * EI) + end_moment * L / EI;
    const double guided_drop = P * std::pow(L, 3) / (12.0 * EI) + P * L / GA;
    const double drop = P * std::pow(L, 3) / (3.0 * EI) +
                        end_moment * L * L / (2.0 * EI) + P * L / GA;
    const Vec3 w = u.segment<3>(6L * node + 3);
    EXPECT_NEAR(-w[1], guided ? 0.0 : turn, 1e-5 * turn) << guided;
    EXPECT_NEAR(u[6L * node + 2], guided ? guided_drop : drop,
                2e-5 * (guided ? guided_drop : drop))
        << guided;
  }
}

/// A tube closed by a plate that grows stiff: its rim goes to a rigid one.
TEST(RigidRims, AreTheLimitOfStiffPlates) {
  const double R = 10.0;
  const double L = 15.0;
  const MappedShell bare = tube(R, L, 0.6, 6, 5);
  const auto quarter = [&](double from) {
    MappedShell shell = shell_shapes::mapped_shell(
        [=](double s, double r) -> Vec3 {
          const double phi = from + std::numbers::pi * r;
          const double radius = R - (R - 3.0) * s;
          return {radius * std::cos(phi), radius * std::sin(phi), L};
        },
        2.0, {.m = 3, .n = 6, .cut = Cut::Mixed});
    std::fill(shell.mesh.section.begin(), shell.mesh.section.end(), 1);
    return shell;
  };
  const MappedShell closed = shell_shapes::joined(
      bare, shell_shapes::joined(quarter(0.0), quarter(std::numbers::pi)));
  const auto solve = [&](const MappedShell& shell, double stiffer, bool rigid) {
    std::vector<NodeSupport> supports;
    std::vector<int> end;
    for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
      const Vec3& x = shell.mesh.nodes[i];
      if (x[2] < 1e-9) {
        hold(supports, {static_cast<int>(i)}, "xyzabc");
      } else if (x[2] > L - 1e-9 && std::hypot(x[0], x[1]) > R - 1e-9) {
        end.push_back(static_cast<int>(i));
      }
    }
    ShellLoads loads;
    loads.nodal =
        VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
    for (const int node : end) {
      loads.nodal.segment<3>(6L * node) = Vec3(3.0, 1.0, 2.0);
    }
    const std::vector<Section> sections = {isotropic(kYoung, 0.3),
                                           isotropic(stiffer * kYoung, 0.3)};
    std::vector<RigidRim> rims;
    if (rigid) {
      rims.push_back(rim_of(shell.mesh, end, {0, 0, L}));
    }
    const VectorX u =
        solved(shell, sections, supports, rims).solve(loads).displacement;
    VectorX first(static_cast<Eigen::Index>(6 * bare.mesh.nodes.size()));
    first = u.head(first.size());
    return first;
  };
  const VectorX rigid = solve(bare, 1.0, true);
  std::vector<double> off;
  for (const double stiffer : {1e3, 1e4, 1e5}) {
    off.push_back((solve(closed, stiffer, false) - rigid).norm() /
                  rigid.norm());
  }
  EXPECT_LT(off[2], 1e-4);
  EXPECT_NEAR(off[0] / off[1], 10.0, 2.0);
  EXPECT_NEAR(off[1] / off[2], 10.0, 0.3);
}

/// Rims that run through all parts, and one with whole facets.
TEST(RigidRims, OfSubstructuresSolveAsTheWhole) {
  for (const unsigned seed : {6U, 7U}) {
    const MappedShell shell = strip(seed, 24);
    const std::vector<Section> sections = {isotropic(kYoung, 0.3, 1.0)};
    std::vector<NodeSupport> supports;
    hold(supports, shell.nodes(at_start), "xyzb");
    RigidRim side = rim_of(shell.mesh, shell.nodes([](double s, double t) {
      return t < 1e-9 && s > 0.1;
    }),
                           {1.0, 0.0, 2.0});
    side.held = {false, true, false, false, false, true};
    side.value[1] = 0.01;
    const RigidRim film = rim_of(
        shell.mesh,
        shell.nodes([](double s, double t) { return s > 0.7 && t > 0.4; }),
        {3.0, 1.0, 0.0});
    const ShellLoads loads = some_loads(shell);
    const VectorX whole = solved(shell, sections, supports, {side, film})
                              .solve(loads)
                              .displacement;
    for (const int levels : {1, 2, 3}) {
      const VectorX parts = solved(shell, sections, supports, {side, film},
                                   {.unknowns = 50, .most_levels = levels})
                                .solve(loads)
                                .displacement;
      EXPECT_LT((parts - whole).norm(), 1e-8 * whole.norm()) << levels;
    }
  }
}

Eigen::Map<VectorX> flat(Points& points) {
  return {points.front().data(), static_cast<Eigen::Index>(3 * points.size())};
}

/// By nodes and by the point, which is held along some axes at some values.
TEST(RigidRims, DerivativesMeetSolvedDifferences) {
  for (const unsigned seed : {8U, 9U, 10U, 11U}) {
    MappedShell shell = strip(seed);
    const std::vector<Section> sections = {isotropic(kYoung, 0.3, 2.0)};
    std::vector<NodeSupport> supports;
    hold(supports, {shell.node(1, 1), shell.node(1, 0)}, "xyzab");
    std::mt19937 random(seed);
    const std::vector<int> nodes = shell.nodes(at_start);
    const Vec3 point = Vec3(-0.5, 0.3, 0.8);
    const auto rim_at = [&](const ShellMesh& mesh, const Vec3& at) {
      std::mt19937 draws(seed);
      RigidRim rim = rim_of(mesh, nodes, at);
      rim.axes = element::LocalAxes{Vec3(1, 0.2, 0.3), Vec3(0, 1, -1)};
      for (int k = 0; k < 6; ++k) {
        rim.held[k] = draws() % 2 == 0;
        rim.value[k] = 0.01 * (k - 2);
      }
      return rim;
    };
    const ShellLoads loads = some_loads(shell);
    const VectorX weights = scattered(shell.mesh, 2.2);
    const auto response = [&](const Points& places, const Vec3& at) {
      MappedShell moved = shell;
      moved.mesh.nodes = places;
      return weights.dot(
          solved(moved, sections, supports, {rim_at(moved.mesh, at)})
              .solve(loads)
              .displacement);
    };
    const ShellSystem system =
        solved(shell, sections, supports, {rim_at(shell.mesh, point)});
    const ShellSolution solution = system.solve(loads);
    const VectorX v = system.solve_forces(weights);
    ShellGradient here = residual_gradient(shell.mesh, sections, loads, v,
                                           solution.displacement);
    const VectorX adjoint = system.stiffness_times(v) - weights;
    const RimPair pair = {solution.displacement, solution.reaction, v, adjoint};
    add_rim_gradient(system.freedom().rims(), pair, here.by_nodes);
    const Vec3 by_point = by_rim_point(system.freedom().rims()[0], pair);
    Points move = shell.mesh.nodes;
    std::uniform_real_distribution<double> unit(-0.02, 0.02);
    for (Vec3& x : move) {
      x = Vec3(unit(random), unit(random), unit(random));
    }
    derivatives::Check check;
    check.tolerance = 1e-6;
    check.exact = flat(here.by_nodes).dot(flat(move));
    check.scale = flat(here.by_nodes).cwiseProduct(flat(move)).lpNorm<1>();
    derivatives::expect_derivative(check, [&](double h) {
      Points places = shell.mesh.nodes;
      flat(places) += h * flat(move);
      return response(places, point);
    });
    const Vec3 shift(0.3, -0.2, 0.4);
    const double h = 1e-3;  // next to linear in the point
    EXPECT_NEAR((response(shell.mesh.nodes, point + h * shift) -
                 response(shell.mesh.nodes, point - h * shift)) /
                    (2.0 * h),
                by_point.dot(shift),
                1e-5 * by_point.cwiseProduct(shift).lpNorm<1>() + 1e-10);
  }
}

TEST(RigidRims, RefuseWhatDoesNotFit) {
  const MappedShell shell = strip(12);
  const std::vector<Section> sections = {isotropic(kYoung, 0.3)};
  const std::vector<int> nodes = shell.nodes(at_start);
  RigidRim rim = rim_of(shell.mesh, nodes, {0, 0, 0});
  const auto expect = [&](const std::vector<NodeSupport>& supports,
                          const std::vector<RigidRim>& rims,
                          const std::string& what) {
    try {
      solved(shell, sections, supports, rims);
      ADD_FAILURE() << "accepted: " << what;
    } catch (const std::exception& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(what));
    }
  };
  expect({}, {rim}, "free to");
  rim.held = {true, true, true, true, true, false};
  expect({}, {rim}, "free to turn about");
  rim.held = kAll;
  RigidRim again = rim_of(shell.mesh, shell.nodes([](double s, double t) {
    return s < 1e-9 || t < 1e-9;
  }),
                          {0, 0, 0});
  again.name = "other";
  expect({}, {rim, again}, "name both in one entry");
  std::vector<NodeSupport> supports;
  hold(supports, {nodes[1]}, "z");
  supports.back().value[2] = 0.1;
  expect(supports, {rim}, "otherwise than that moves");
  supports.back().value[2] = 0.0;
  solved(shell, sections, supports, {rim});
  rim.held[2] = false;
  expect(supports, {rim}, "otherwise than that moves");
  rim.axes = element::LocalAxes{Vec3(1, 0, 0), Vec3(2, 0, 0)};
  expect({}, {rim}, "span no plane");
  RigidRim empty{.name = "none"};
  expect({}, {empty}, "0 nodes");
  RigidRim outside = rim_of(shell.mesh, nodes, {0, 0, 0});
  outside.nodes.back() = 100000;
  expect({}, {outside}, "100000");
  // A single node, or nodes on a line, are as good as others: they turn along.
  RigidRim one = rim_of(shell.mesh, {nodes[0]}, {0, 0, 1});
  one.held = kAll;
  EXPECT_GT(solved(shell, sections, {}, {one}).freedom().unknowns(), 0);
  RigidRim whole = rim_of(
      shell.mesh, shell.nodes([](double, double) { return true; }), {0, 0, 0});
  whole.held = kAll;
  expect({}, {whole}, "free to move");
}

}  // namespace
}  // namespace meniscus::rigid_rims_test
