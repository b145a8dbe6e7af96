#include "fea/shell_actions/line_load.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::line_load_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::MappedShell;

constexpr double kPi = std::numbers::pi;

/// Those of facets whose three nodes hold.
std::vector<FacetEdge> edges_where(
    const ShellMesh& mesh, const std::function<bool(const Vec3&)>& where) {
  std::vector<FacetEdge> edges;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const auto& nodes = mesh.facets[f];
    for (int e = 0; e < 3; ++e) {
      if (where(mesh.nodes[nodes[e]]) &&
          where(mesh.nodes[nodes[(e + 1) % 3]]) &&
          where(mesh.nodes[nodes[3 + e]])) {
        edges.push_back({static_cast<int>(f), e});
      }
    }
  }
  return edges;
}

/// Of a patch drawn at random; its rim at t = 0 is a curve, or a straight line.
MappedShell patch(unsigned seed, bool straight) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  const double a = any(random);
  const double b = any(random);
  const double c = any(random);
  const double bend = straight ? 0.0 : a;
  MappedShell shell = shell_shapes::mapped_shell(
      [=](double s, double t) -> Vec3 {
        return {2.0 * s, t + bend * s * (1.0 - s),
                0.7 * s + b * t * t + c * s * t};
      },
      0.1, {.m = 3, .n = 2});
  for (Vec3& t : shell.mesh.thickness) {
    t += 0.05 * Vec3(any(random), any(random), any(random));
  }
  return shell;
}

LineLoad random_load(unsigned seed, std::vector<FacetEdge> edges) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  const auto vector = [&]() {
    return Vec3(any(random), any(random), any(random));
  };
  LineLoad load{.edges = std::move(edges), .name = "rim"};
  load.point = vector();
  load.force = vector();
  load.moment = vector();
  return load;
}

std::vector<FacetEdge> low_edge(const MappedShell& shell) {
  const std::vector<int> low =
      shell.nodes([](double, double t) { return t < 1e-9; });
  std::vector<char> is_low(shell.mesh.nodes.size(), 0);
  for (const int node : low) {
    is_low[node] = 1;
  }
  std::vector<FacetEdge> edges;
  for (std::size_t f = 0; f < shell.mesh.facets.size(); ++f) {
    for (int e = 0; e < 3; ++e) {
      if (is_low[shell.mesh.facets[f][3 + e]] != 0) {
        edges.push_back({static_cast<int>(f), e});
      }
    }
  }
  return edges;
}

TEST(LineLoad, HasItsForceAndMoment) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const MappedShell shell = patch(seed, seed % 2 == 0);
    LineLoad load = random_load(seed, low_edge(shell));
    const Vec3 about(0.3, -1.0, 0.4);
    const auto sums = [&]() {
      const VectorX f = line_forces(shell.mesh, load);
      std::pair<Vec3, Vec3> sum(Vec3::Zero(), Vec3::Zero());
      for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
        const auto at = 6L * static_cast<Eigen::Index>(i);
        sum.first += f.segment<3>(at);
        sum.second +=
            (shell.mesh.nodes[i] - about).cross(Vec3(f.segment<3>(at))) +
            f.segment<3>(at + 3);
      }
      return sum;
    };
    auto [force, moment] = sums();
    EXPECT_LT((force - load.force).norm(), 1e-12);
    EXPECT_LT(
        (moment - load.moment - (*load.point - about).cross(load.force)).norm(),
        1e-9);
    // Without a point nothing turns about the middle of the line.
    load.point.reset();
    load.moment.setZero();
    const VectorX f = line_forces(shell.mesh, load);
    for (Eigen::Index i = 3; i < f.size(); i += 6) {
      EXPECT_LT(f.segment<3>(i).norm(), 1e-13);
    }
  }
}

/// A rigid motion is moved by the force at its point, and turned by the moment.
TEST(LineLoad, WorksOnRigidMotionsAsAForceAtItsPoint) {
  const MappedShell shell = patch(3, false);
  const LineLoad load = random_load(5, low_edge(shell));
  const Vec3 move(0.1, -0.2, 0.3);
  const Vec3 turn(-0.4, 0.2, 0.5);
  VectorX v(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
  for (std::size_t i = 0; i < shell.mesh.nodes.size(); ++i) {
    const auto at = 6L * static_cast<Eigen::Index>(i);
    v.segment<3>(at) = move + turn.cross(shell.mesh.nodes[i]);
    v.segment<3>(at + 3) = turn;
  }
  const LineGradient by = line_gradient(shell.mesh, load, v, nullptr);
  EXPECT_NEAR(
      by.value,
      load.force.dot(move + turn.cross(*load.point)) + load.moment.dot(turn),
      1e-10);
  EXPECT_LT((by.by_moment - turn).norm(), 1e-10);
  EXPECT_NEAR(by.value, v.dot(line_forces(shell.mesh, load)), 1e-12);
}

Eigen::Map<const VectorX> flat_of(const std::vector<Vec3>& rows) {
  return {rows.front().data(), static_cast<Eigen::Index>(3 * rows.size())};
}

void expect_derivatives(const MappedShell& shell, const LineLoad& load) {
  VectorX v(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
  std::vector<Vec3> move(shell.mesh.nodes.size());
  for (std::size_t i = 0; i < move.size(); ++i) {
    const auto at = 6L * static_cast<Eigen::Index>(i);
    v.segment<3>(at) = derivatives::wave(shell.mesh.nodes[i], 0.3);
    v.segment<3>(at + 3) = derivatives::wave(shell.mesh.nodes[i], 1.3);
    move[i] = 0.1 * derivatives::wave(shell.mesh.nodes[i], 0.8);
  }
  std::vector<Vec3> thicker(shell.mesh.facets.size());
  for (std::size_t f = 0; f < thicker.size(); ++f) {
    thicker[f] = 0.02 * derivatives::wave(shell.mesh.thickness[f],
                                          0.4 * static_cast<double>(f));
  }
  ShellGradient by{.by_nodes = Points(move.size(), Vec3::Zero()),
                   .by_thickness = Points(thicker.size(), Vec3::Zero())};
  const LineGradient numbers = line_gradient(shell.mesh, load, v, &by);
  const auto work = [&](const ShellMesh& mesh, const LineLoad& acting) {
    return v.dot(line_forces(mesh, acting));
  };
  const double size = std::abs(work(shell.mesh, load));
  derivatives::Check check;
  check.exact = flat_of(by.by_nodes).dot(flat_of(move));
  check.scale =
      flat_of(by.by_nodes).cwiseProduct(flat_of(move)).lpNorm<1>() + size;
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh moved = shell.mesh;
    for (std::size_t i = 0; i < move.size(); ++i) {
      moved.nodes[i] += h * move[i];
    }
    return work(moved, load);
  });
  check.exact = flat_of(by.by_thickness).dot(flat_of(thicker));
  check.scale =
      flat_of(by.by_thickness).cwiseProduct(flat_of(thicker)).lpNorm<1>() +
      size;
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh other = shell.mesh;
    for (std::size_t f = 0; f < thicker.size(); ++f) {
      other.thickness[f] += h * thicker[f];
    }
    return work(other, load);
  });
  const Vec3 d(0.3, -0.7, 0.5);
  check.exact = numbers.by_force.dot(d) + numbers.by_moment.dot(2.0 * d) +
                numbers.by_point.dot(-d);
  check.scale = size + std::abs(check.exact);
  derivatives::expect_derivative(check, [&](double h) {
    LineLoad other = load;
    other.force += h * d;
    other.moment += 2.0 * h * d;
    if (other.point) {
      *other.point -= h * d;
    }
    return work(shell.mesh, other);
  });
}

TEST(LineLoad, WorkMeetsDifferences) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const MappedShell shell = patch(seed, false);
    LineLoad load = random_load(seed + 20, low_edge(shell));
    expect_derivatives(shell, load);
    load.point.reset();
    expect_derivatives(shell, load);
  }
}

TEST(LineLoad, RefusesWhatHasNoLength) {
  const MappedShell shell = patch(1, false);
  EXPECT_THROW(line_forces(shell.mesh, random_load(1, {})), InvalidInput);
}

/// A clamped strip whose end a moment turns about the end itself.
TEST(LineLoad, AStraightRimBendsItsStrip) {
  constexpr double kLength = 3.0, kWidth = 0.7, kThick = 0.1, kModulus = 50.0;
  const MappedShell strip = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {kLength * s, kWidth * t, 0.0};
      },
      kThick, {.m = 6, .n = 2, .shake = 0.2});
  const std::vector<Section> sections = {
      shell_shapes::isotropic(kModulus, 0.0)};
  std::vector<NodeSupport> supports;
  shell_shapes::hold(supports,
                     strip.nodes([](double s, double) { return s < 1e-9; }),
                     "xyzabc");
  const ShellSystem system(strip.mesh, sections, supports);
  ShellLoads loads;
  loads.nodal = line_forces(
      strip.mesh,
      {.edges = edges_where(
           strip.mesh, [](const Vec3& x) { return x.x() > kLength - 1e-9; }),
       .point = Vec3(kLength, 0.5 * kWidth, 0.0),
       .moment = Vec3(0.0, 2e-4, 0.0),
       .name = "end"});
  const VectorX u = system.solve(loads).displacement;
  const double bending = kModulus * kWidth * std::pow(kThick, 3) / 12.0;
  const double sinks = 2e-4 * kLength * kLength / (2.0 * bending);
  for (const int node :
       strip.nodes([](double s, double) { return s > 1.0 - 1e-9; })) {
    EXPECT_NEAR(u[6L * node + 2], -sinks, 1e-9 * sinks);
    EXPECT_NEAR(u[6L * node + 4], 2e-4 * kLength / bending, 1e-9);
  }
}

constexpr double kRadius = 2.0;
constexpr double kLong = 12.0;
constexpr double kWall = 0.1;

/// About x, of two halves.
ShellMesh tube(int around, int along) {
  const auto half = [&](double from) {
    return shell_shapes::mapped_shell(
        [from](double s, double t) -> Vec3 {
          const double angle = from + kPi * s;
          return {kLong * t, kRadius * std::cos(angle),
                  kRadius * std::sin(angle)};
        },
        kWall, {.m = around / 2, .n = along});
  };
  return shell_shapes::joined(half(0.0), half(kPi)).mesh;
}

/// Plane sections: a cantilever of a tube, turned by a moment at its end.
TEST(LineLoad, ABendingMomentBendsATubeAsABeam) {
  constexpr double kModulus = 1e3, kMoment = 5.0;
  // The moments of the wall's end are those of a flat wall: r t / (12^1/2 L^2).
  constexpr double kNear = 1e-3;
  const double I = kPi * std::pow(kRadius, 3) * kWall *
                   (1.0 + std::pow(0.5 * kWall / kRadius, 2));
  double worst_before = 0.0;
  for (const int n : {8, 16}) {
    const ShellMesh mesh = tube(n, n);
    const std::vector<Section> sections = {
        shell_shapes::isotropic(kModulus, 0.0)};
    std::vector<NodeSupport> supports;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      if (mesh.nodes[i].x() < 1e-9) {
        supports.push_back({.node = static_cast<int>(i),
                            .held = {true, true, true, true, true, true}});
      }
    }
    const LineLoad load{
        .edges = edges_where(
            mesh, [](const Vec3& x) { return x.x() > kLong - 1e-9; }),
        .point = Vec3(kLong, 0.0, 0.0),
        .moment = Vec3(0.0, kMoment, 0.0),
        .name = "end"};
    ShellLoads loads;
    loads.nodal = line_forces(mesh, load);
    const ShellSystem system(mesh, sections, supports);
    const VectorX u = system.solve(loads).displacement;
    const LineGradient moved = line_gradient(mesh, load, u, nullptr);
    const double sinks = kMoment * kLong * kLong / (2.0 * kModulus * I);
    const double off = std::abs(moved.by_force.z() / -sinks - 1.0);
    EXPECT_LT(off, kNear);
    EXPECT_LT(
        std::abs(moved.by_moment.y() * kModulus * I / (kMoment * kLong) - 1.0),
        kNear);
    // M z / I in the middle of the wall, off both ends.
    const auto stress =
        averaged_stress(mesh, shell_stress(mesh, sections, loads, u));
    double worst = 0.0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
      for (std::size_t i = 0; i < 6; ++i) {
        const Vec3& x = mesh.nodes[mesh.facets[f][i]];
        if (std::abs(x.x() - 0.5 * kLong) < 0.2 * kLong) {
          worst = std::max(
              worst, std::abs(stress[f][i].middle[0] - kMoment * x.z() / I) /
                         (kMoment * kRadius / I));
        }
      }
    }
    EXPECT_LT(worst, n == 8 ? 0.06 : 0.015);
    if (n == 16) {
      EXPECT_GT(worst_before / worst, 3.0) << worst_before << " " << worst;
    }
    worst_before = worst;
  }
}

}  // namespace
}  // namespace meniscus::line_load_test
