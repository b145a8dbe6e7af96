#include "fea/shell/shell_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell/shell_system.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_loads_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::hold;
using shell_shapes::MappedShell;

constexpr double kPi = std::numbers::pi;
constexpr double kExact = 1e-9;

/// A strip along x of width b without contraction, held at x = 0.
struct Strip {
  double L, b, t, E;
  MappedShell shell;
  std::vector<Section> sections;
  std::vector<NodeSupport> supports;

  explicit Strip(unsigned seed, double contraction = 0.0) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(0.5, 2.0);
    L = 4.0 * number(random);
    b = number(random);
    t = 0.1 * number(random);
    E = 1e4 * number(random);
    shell = shell_shapes::mapped_shell(
        [&](double s, double r) -> Vec3 {
          return {s * L, r * b, 0.0};
        },
        t, {.m = 8, .n = 2, .cut = Cut::Mixed, .shake = 0.2, .seed = seed});
    sections = {shell_shapes::isotropic(E, contraction, 3.0)};
    hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
         "xyzabc");
  }
  ShellLoads tip(const Vec3& force, const Vec3& moment) const {
    ShellLoads loads;
    for (const auto& e :
         shell.edges([](double s, double) { return s > 1.0 - 1e-9; })) {
      loads.edges.push_back({e, force / b, moment / b});
    }
    return loads;
  }
  VectorX solve(const ShellLoads& loads) const {
    return ShellSystem(shell.mesh, sections, supports)
        .solve(loads)
        .displacement;
  }
  Six tip_motion(const VectorX& u) const {
    return u.segment<6>(6L * shell.node(1.0, 0.0));
  }
};

TEST(ShellLoads, AMomentAtAnEdgeBendsAStripAsABeam) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Strip strip(seed);
    const double EI = strip.E * strip.b * std::pow(strip.t, 3) / 12.0;
    const double M = 2.0;
    const Six tip =
        strip.tip_motion(strip.solve(strip.tip(Vec3::Zero(), {0, -M, 0})));
    EXPECT_NEAR(tip[2] / (M * strip.L * strip.L / (2.0 * EI)), 1.0, kExact);
    EXPECT_NEAR(tip[4] / (-M * strip.L / EI), 1.0, kExact);
  }
}

/// Cubic in the length: not in the space, near it with eight elements.
TEST(ShellLoads, AForceAtAnEdgeBendsAStripAsABeam) {
  constexpr double kEightCells = 2e-3;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Strip strip(seed);
    const double A = strip.b * strip.t;
    const double EI = strip.E * A * strip.t * strip.t / 12.0;
    const double P = 2.0;
    const double beam = P * std::pow(strip.L, 3) / (3.0 * EI) +
                        P * strip.L / (5.0 / 6.0 * 0.5 * strip.E * A);
    const Six bent =
        strip.tip_motion(strip.solve(strip.tip({0, 0, P}, Vec3::Zero())));
    EXPECT_NEAR(bent[2] / beam, 1.0, kEightCells);
    const Six pulled =
        strip.tip_motion(strip.solve(strip.tip({P, 0, 0}, Vec3::Zero())));
    EXPECT_NEAR(pulled[0] / (P * strip.L / (strip.E * A)), 1.0, kExact);
  }
}

/// On a wall that lies beside its surface: pulled, not bent.
TEST(ShellLoads, TractionOnAnEndActsInTheMiddleOfTheWall) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Strip strip(seed);
    strip.sections[0].offset = 0.1 * (static_cast<double>(seed) + 1.0);
    ShellLoads loads;
    for (std::size_t f = 0; f < strip.shell.mesh.facets.size(); ++f) {
      for (int e = 0; e < 3; ++e) {
        if (strip.shell.place[strip.shell.mesh.facets[f][3 + e]][0] >
            1.0 - 1e-9) {
          loads.tractions.push_back({.facet = static_cast<int>(f),
                                     .edge = e,
                                     .traction = Vec3(5.0, 0.0, 0.0),
                                     .pressure = 2.0});
        }
      }
    }
    EXPECT_EQ(loads.tractions.size(), 2U);
    const VectorX u = strip.solve(loads);
    const Six tip = strip.tip_motion(u);
    EXPECT_NEAR(tip[0] / (3.0 * strip.L / strip.E), 1.0, kExact);
    EXPECT_LT(std::abs(tip[2]) + std::abs(tip[4]), kExact);
    for (const FacetStress& facet :
         shell_stress(strip.shell.mesh, strip.sections, loads, u)) {
      EXPECT_NEAR(facet[0].negative[0], 3.0, 1e-7);
      EXPECT_NEAR(facet[0].positive[0], 3.0, 1e-7);
    }
  }
}

TEST(ShellLoads, FreeExpansionHasNoStress) {
  constexpr double kAlpha = 1e-5;
  Strip strip(3, 0.3);
  strip.sections[0].laminate.plies[0].material.thermal_expansion.setConstant(
      kAlpha);
  // Held at a corner, and free of everything else.
  strip.supports.clear();
  const int corner = strip.shell.node(0.0, 0.0);
  hold(strip.supports, {corner}, "xyzabc");
  ShellLoads loads;
  loads.temperature = WallTemperature{.mean = 40.0, .across = 30.0};
  const VectorX u = strip.solve(loads);
  const Six tip = strip.tip_motion(u);
  EXPECT_NEAR(tip[0] / (kAlpha * 40.0 * strip.L), 1.0, 1e-8);
  // The positive face is longer: the edges go down.
  const double bend = kAlpha * 30.0 / strip.t;
  EXPECT_NEAR(tip[2] / (-0.5 * bend * strip.L * strip.L), 1.0, 1e-8);
  for (const FacetStress& facet :
       shell_stress(strip.shell.mesh, strip.sections, loads, u)) {
    for (const WallStress& wall : facet) {
      for (const auto& s : {wall.negative, wall.middle, wall.positive}) {
        EXPECT_LT(element::von_mises(s), 1e-6 * strip.E * kAlpha * 40.0);
      }
    }
  }
}

TEST(ShellLoads, HeldExpansionPresses) {
  constexpr double kAlpha = 1e-5;
  Strip strip(4, 0.3);
  strip.sections[0].laminate.plies[0].material.thermal_expansion.setConstant(
      kAlpha);
  strip.supports.clear();
  hold(strip.supports, strip.shell.nodes([](double, double) { return true; }),
       "xyzabc");
  ShellLoads loads;
  loads.temperature = WallTemperature{.mean = 40.0, .across = 30.0};
  const VectorX u = VectorX::Zero(
      static_cast<Eigen::Index>(6 * strip.shell.mesh.nodes.size()));
  const auto stress = shell_stress(strip.shell.mesh, strip.sections, loads, u);
  const double per_degree = -strip.E * kAlpha / 0.7;
  EXPECT_NEAR(stress[0][0].middle[0] / (40.0 * per_degree), 1.0, kExact);
  EXPECT_NEAR(stress[0][0].positive[1] / (55.0 * per_degree), 1.0, kExact);
  EXPECT_NEAR(stress[0][0].negative[0] / (25.0 * per_degree), 1.0, kExact);
}

/// An eighth of a sphere between its planes of symmetry.
struct Sphere {
  double R, t;
  double E = 200.0;
  MappedShell shell;
  std::vector<Section> sections = {shell_shapes::isotropic(E, 0.3, 2.0)};
  std::vector<NodeSupport> supports;

  Sphere(double radius, double thickness, int n)
      : R(radius),
        t(thickness),
        shell(shell_shapes::triangle_shell(
            [=](double s, double r) -> Vec3 {
              return radius * Vec3(1.0 - s - r, s, r).normalized();
            },
            thickness, {.m = n, .shake = 0.2})) {
    hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }),
         "yac");
    hold(supports, shell.nodes([](double, double r) { return r < 1e-9; }),
         "zab");
    hold(supports,
         shell.nodes([](double s, double r) { return s + r > 1.0 - 1e-9; }),
         "xbc");
  }
};

/// Root mean square over nodes of what differs from a thick sphere's motion of
/// the middle surface and from its stresses at the faces (Lame), relative.
struct SphereErrors {
  double motion = 0.0;
  double stress = 0.0;
};

SphereErrors pressed(const Sphere& sphere) {
  const double a = sphere.R - 0.5 * sphere.t;
  const double b = sphere.R + 0.5 * sphere.t;
  const double k = a * a * a / (b * b * b - a * a * a);
  const double r = sphere.R;
  const double w = k / sphere.E * (0.4 * r + 0.65 * b * b * b / (r * r));
  ShellLoads loads;
  const ShellMesh& mesh = sphere.shell.mesh;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    loads.pressures.push_back({static_cast<int>(f), 1.0});
  }
  const ShellSystem system(mesh, sphere.sections, sphere.supports);
  const VectorX u = system.solve(loads).displacement;
  SphereErrors errors;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const double out =
        u.segment<3>(static_cast<Eigen::Index>(6 * i)).dot(mesh.nodes[i]);
    errors.motion += std::pow(out / (w * r) - 1.0, 2);
  }
  errors.motion =
      std::sqrt(errors.motion / static_cast<double>(mesh.nodes.size()));
  double count = 0.0;
  const auto add = [&](const element::Stress& s, double at) {
    // Hoop less radial stress.
    const double exact = 1.5 * k * std::pow(b / at, 3);
    errors.stress += std::pow(element::von_mises(s) / exact - 1.0, 2);
    count += 1.0;
  };
  for (const FacetStress& facet :
       averaged_stress(mesh, shell_stress(mesh, sphere.sections, loads, u))) {
    for (const WallStress& wall : facet) {
      add(wall.negative, a);
      add(wall.positive, b);
    }
  }
  errors.stress = std::sqrt(errors.stress / count);
  return errors;
}

TEST(ShellLoads, PressureInASphereStretchesItEvenly) {
  const SphereErrors coarse = pressed(Sphere(1.0, 0.01, 5));
  const SphereErrors fine = pressed(Sphere(1.0, 0.01, 10));
  EXPECT_LT(fine.motion, std::min(6e-3, coarse.motion / 3.0));
  EXPECT_LT(fine.stress, std::min(2e-2, coarse.stress / 3.0));
}

/// Errors of the theory itself, on a mesh fine enough: of motions the square of
/// t / R; of stresses the first power, as no wall gets thinner.
TEST(ShellLoads, APressedSphereNearsLame) {
  for (const double t : {0.2, 0.1}) {
    const SphereErrors errors = pressed(Sphere(1.0, t, 16));
    EXPECT_LT(errors.motion, 0.5 * t * t);
    EXPECT_LT(errors.stress, 0.55 * t);
  }
}

/// A ring that spins: stress density rate^2 R^2 in the hoops.
TEST(ShellLoads, SpinStretchesARing) {
  const double R = 2.0;
  const double rate = 3.0;
  const MappedShell shell = shell_shapes::mapped_shell(
      [&](double s, double r) -> Vec3 {
        const double a = 0.5 * kPi * s;
        return {R * std::cos(a), R * std::sin(a), 0.3 * r};
      },
      0.01, {.m = 8, .n = 2, .cut = Cut::Mixed});
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return s < 1e-9; }), "yac");
  hold(supports, shell.nodes([](double s, double) { return s > 1 - 1e-9; }),
       "xbc");
  hold(supports, {shell.node(0, 0)}, "z");
  const std::vector<Section> sections = {
      shell_shapes::isotropic(100.0, 0.3, 2.0)};
  ShellLoads loads;
  loads.spin = loads::Spin{{0, 0, 5}, {0, 0, 2}, rate};
  const ShellSystem system(shell.mesh, sections, supports);
  const VectorX u = system.solve(loads).displacement;
  const double stress = 2.0 * rate * rate * R * R;
  EXPECT_NEAR(u[6L * shell.node(0, 1)] / (stress * R / 100.0), 1.0, 1e-3);
}

/// Weight is mass times gravity, also of a wall that lies beside its surface.
TEST(ShellLoads, GravityIsMassTimesItself) {
  const Sphere sphere(1.0, 0.1, 10);
  std::vector<Section> sections = sphere.sections;
  sections[0].offset = 0.5;
  ShellLoads loads;
  loads.gravity = {0.3, -2.0, 1.0};
  const VectorX f = nodal_forces(sphere.shell.mesh, sections, loads);
  Vec3 total = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < sphere.shell.mesh.nodes.size(); ++i) {
    const Vec3 force = f.segment<3>(static_cast<Eigen::Index>(6 * i));
    total += force;
    moment += sphere.shell.mesh.nodes[i].cross(force) +
              f.segment<3>(static_cast<Eigen::Index>(6 * i + 3));
  }
  constexpr double kMesh = 1e-3;  // of the sphere's volume
  const double mass =
      2.0 * kPi / 6.0 * (std::pow(1.1, 3) - 1.0);  // density x an eighth
  EXPECT_LT((total - mass * loads.gravity).norm() / total.norm(), kMesh);
  // The center of mass of half a shell is 3/8 (b^4 - a^4) / (b^3 - a^3) up.
  const double up = 0.375 * (std::pow(1.1, 4) - 1.0) / (std::pow(1.1, 3) - 1.0);
  EXPECT_LT((moment - Vec3::Constant(up).cross(total)).norm() / moment.norm(),
            kMesh);
}

TEST(ShellLoads, RefusesWhatIsNotThere) {
  const Strip strip(1);
  ShellLoads loads;
  loads.pressures = {{1000, 1.0}};
  EXPECT_THROW(strip.solve(loads), InvalidInput);
  loads = {};
  loads.pulls = {{0, 3, 1.0}};
  EXPECT_THROW(strip.solve(loads), InvalidInput);
  loads = {};
  loads.tractions = {{.facet = -1}};
  EXPECT_THROW(strip.solve(loads), InvalidInput);
  loads = {};
  loads.edges = {{{0, 1, -1}}};
  EXPECT_THROW(strip.solve(loads), InvalidInput);
  loads = {};
  loads.spin = loads::Spin{{0, 0, 0}, {0, 0, 0}, 1.0};
  EXPECT_THROW(strip.solve(loads), InvalidInput);
  loads = {};
  loads.nodal = VectorX::Zero(5);
  EXPECT_THROW(strip.solve(loads), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_loads_test
