#include "tests/support/shell_benchmarks.h"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "core/math/gauss_rule.h"
#include "fea/shell/shell_system.h"
#include "fea/shell_modes/shell_modes.h"

namespace meniscus::shell_benchmarks {

namespace {

using namespace shell;  // NOLINT: what is measured
using shell_shapes::hold;
using shell_shapes::isotropic;
using shell_shapes::MappedShell;

constexpr double kPi = std::numbers::pi;

bool at0(double s) { return s < 1e-9; }
bool at1(double s) { return s > 1.0 - 1e-9; }

/// Displacements of a solved shell; middles are held where they are no nodes.
VectorX solved(const MappedShell& shell, const Section& section,
               std::vector<NodeSupport> supports, const ShellLoads& loads,
               const Element& element) {
  if (element.corners_only) {
    std::vector<char> corner(shell.mesh.nodes.size(), 0);
    for (const auto& f : shell.mesh.facets) {
      corner[f[0]] = corner[f[1]] = corner[f[2]] = 1;
    }
    std::vector<int> middles;
    for (std::size_t i = 0; i < corner.size(); ++i) {
      if (corner[i] == 0) {
        middles.push_back(static_cast<int>(i));
      }
    }
    hold(supports, middles, "xyzabc");
  }
  const std::vector<Section> sections = {section};
  const ShellSystem system(shell.mesh, sections, supports, *element.rule);
  return system.solve(loads).displacement;
}

ShellLoads point_load(const MappedShell& shell, int node, const Vec3& force) {
  ShellLoads loads;
  loads.nodal =
      VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
  loads.nodal.segment<3>(6L * node) = force;
  return loads;
}

/// Forces of a body as the element's own functions share them.
ShellLoads spread(
    const MappedShell& shell, const Element& element,
    const std::function<Vec3(const Vec3& x, const Vec3& n)>& per_area) {
  ShellLoads loads;
  loads.nodal =
      VectorX::Zero(static_cast<Eigen::Index>(6 * shell.mesh.nodes.size()));
  for (const auto& nodes : shell.mesh.facets) {
    std::array<Triple<double>, kNodes> X;
    for (int i = 0; i < kNodes; ++i) {
      const Vec3& x = shell.mesh.nodes[nodes[i]];
      X[i] = {x[0], x[1], x[2]};
    }
    for (const FacetPoint& p : *element.rule) {
      const FacetFrame<double> frame = facet_frame(X, p, nullptr);
      Vec3 x = Vec3::Zero();
      for (int i = 0; i < kNodes; ++i) {
        x += p.shape[i] * as_vector(X[i]);
      }
      const Vec3 force =
          p.weight * frame.area * per_area(x, as_vector(frame.axes[2]));
      for (int i = 0; i < kNodes; ++i) {
        loads.nodal.segment<3>(6L * nodes[i]) += p.shape[i] * force;
      }
    }
  }
  return loads;
}

FacetRule plain(FacetRule rule) {
  for (FacetPoint& p : rule) {
    for (int j = 0; j < kNodes; ++j) {
      for (int i = 0; i < kFunctions; ++i) {
        for (int a = 0; a < 2; ++a) {
          p.carried(2 * i + a, j) = p.shape[i] * p.slope(j, a);
        }
      }
      for (int i = 0; i < kNodes; ++i) {
        p.stretched(3 * i, j) = p.slope(i, 0) * p.slope(j, 0);
        p.stretched(3 * i + 1, j) = 0.5 * (p.slope(i, 0) * p.slope(j, 1) +
                                           p.slope(i, 1) * p.slope(j, 0));
        p.stretched(3 * i + 2, j) = p.slope(i, 1) * p.slope(j, 1);
      }
    }
  }
  return rule;
}

/// Linear functions of the corners, the bubble stays.
void make_linear(FacetPoint& p, double xi, double eta) {
  p.shape = {1.0 - xi - eta, xi, eta, 0.0, 0.0, 0.0, p.shape[kNodes]};
  p.slope.topRows<kNodes>() << -1, -1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0;
  p.curve.setZero();
}

/// One tangential moment an edge: the form (a - c y, b + c x).
Eigen::Matrix<double, 2, 3> lowest_forms(double xi, double eta) {
  Eigen::Matrix<double, 2, 3> m;
  m << 1, 0, -eta, 0, 1, xi;
  return m;
}

template <class FormAt>
Vec3 edge_moments(const FormAt& form) {
  constexpr double kCorner[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  Vec3 moments = Vec3::Zero();
  for (int e = 0; e < 3; ++e) {
    const double* from = kCorner[e];
    const double* to = kCorner[(e + 1) % 3];
    const Eigen::Vector2d along(to[0] - from[0], to[1] - from[1]);
    for (const GaussPoint& g : gauss_rule(3)) {
      moments[e] += g.weight * along.dot(form(from[0] + g.at * along[0],
                                              from[1] + g.at * along[1]));
    }
  }
  return moments;
}

FacetRule linear_rule() {
  Mat3 V;
  for (int k = 0; k < 3; ++k) {
    V.col(k) = edge_moments([&](double x, double y) -> Eigen::Vector2d {
      return lowest_forms(x, y).col(k);
    });
  }
  const Mat3 solve = V.inverse();
  FacetRule rule = facet_rule();
  const FacetRule quadratic = facet_rule();
  for (FacetPoint& p : rule) {
    // Places of the rule, from its quadratic functions.
    const double xi = p.shape[1] + 0.5 * (p.shape[4] + p.shape[3]);
    const double eta = p.shape[2] + 0.5 * (p.shape[5] + p.shape[4]);
    make_linear(p, xi, eta);
  }
  rule = plain(rule);
  for (FacetPoint& p : rule) {
    for (int i = 0; i < kFunctions; ++i) {
      for (int j = 0; j < kNodes; ++j) {
        const Vec3 moments =
            edge_moments([&](double x, double y) -> Eigen::Vector2d {
              FacetPoint at = facet_functions(x, y);
              make_linear(at, x, y);
              return at.shape[i] * at.slope.row(j).transpose();
            });
        p.carried.block<2, 1>(2 * i, j) =
            lowest_forms(p.shape[1], p.shape[2]) * (solve * moments);
      }
    }
  }
  return rule;
}

double hemisphere(double thickness, double force, const GridOptions& options,
                  const Element& element) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double a = 0.5 * kPi * s;
        const double b = 0.4 * kPi * t;
        return {10 * std::cos(a) * std::cos(b), 10 * std::sin(a) * std::cos(b),
                10 * std::sin(b)};
      },
      thickness, options);
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return at0(s); }), "yac");
  hold(supports, shell.nodes([](double s, double) { return at1(s); }), "xbc");
  const int a = shell.node(0, 0);
  const int b = shell.node(1, 0);
  hold(supports, {a}, "z");
  ShellLoads loads = point_load(shell, a, {force, 0, 0});
  loads.nodal[6L * b + 1] = -force;
  return solved(shell, isotropic(6.825e7, 0.3), supports, loads,
                element)[6L * a];
}

}  // namespace

Element program() { return {"program", &facet_rule()}; }

Element plain_quadratic() {
  static const FacetRule rule = plain(facet_rule());
  return {"six nodes, plain", &rule};
}

Element reduced_quadratic() {
  static const FacetRule rule = [] {
    FacetRule three;
    for (const auto& [xi, eta] :
         {std::array{1.0, 1.0}, {4.0, 1.0}, {1.0, 4.0}}) {
      three.push_back(facet_functions(xi / 6.0, eta / 6.0));
      three.back().weight = 1.0 / 6.0;
    }
    return plain(three);
  }();
  return {"six nodes, three points", &rule};
}

Element three_nodes() {
  static const FacetRule rule = linear_rule();
  return {"three nodes", &rule, true};
}

double scordelis_lo(const GridOptions& options, const Element& element) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double a = s * kPi * 40.0 / 180.0;
        return {25.0 * std::sin(a), 25.0 * t, 25.0 * std::cos(a)};
      },
      0.25, options);
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double, double t) { return at1(t); }), "xz");
  hold(supports, shell.nodes([](double, double t) { return at0(t); }), "yac");
  hold(supports, shell.nodes([](double s, double) { return at0(s); }), "xbc");
  const ShellLoads loads =
      spread(shell, element, [](const Vec3&, const Vec3&) -> Vec3 {
        return {0, 0, -90.0};
      });
  return -solved(shell, isotropic(4.32e8, 0.0), supports, loads,
                 element)[6L * shell.node(1, 0) + 2] /
         0.3024;
}

double pinched_cylinder(const GridOptions& options, const Element& element) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double a = 0.5 * kPi * s;
        return {300.0 * std::sin(a), 300.0 * t, 300.0 * std::cos(a)};
      },
      3.0, options);
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double, double t) { return at1(t); }), "xzb");
  hold(supports, shell.nodes([](double, double t) { return at0(t); }), "yac");
  hold(supports, shell.nodes([](double s, double) { return at0(s); }), "xbc");
  hold(supports, shell.nodes([](double s, double) { return at1(s); }), "zab");
  const int top = shell.node(0, 0);
  return -solved(shell, isotropic(3e6, 0.3), supports,
                 point_load(shell, top, {0, 0, -0.25}), element)[6L * top + 2] /
         1.8248e-5;
}

double holed_hemisphere(const GridOptions& options, const Element& element) {
  return hemisphere(0.04, 1.0, options, element) / 0.0924;
}

double thin_hemisphere(const GridOptions& options, const Element& element) {
  return hemisphere(0.004, 1e-3, options, element) / 0.0924;
}

double nafems_le3(const GridOptions& options, const Element& element) {
  const MappedShell shell = shell_shapes::triangle_shell(
      [](double s, double t) -> Vec3 {
        return 10.0 * Vec3(1.0 - s - t, s, t).normalized();
      },
      0.04, options);
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return at0(s); }), "yac");
  hold(supports, shell.nodes([](double s, double t) { return at1(s + t); }),
       "xbc");
  hold(supports, {shell.node(0, 1)}, "z");
  const int a = shell.node(0, 0);
  ShellLoads loads = point_load(shell, a, {2000.0, 0, 0});
  loads.nodal[6L * shell.node(1, 0) + 1] = -2000.0;
  return solved(shell, isotropic(6.825e10, 0.3), supports, loads,
                element)[6L * a] /
         0.185;
}

namespace {

/// A quarter of a unit square plate from its middle.
struct QuarterPlate {
  MappedShell shell;
  std::vector<NodeSupport> supports;

  QuarterPlate(double thickness, bool clamped, const GridOptions& options)
      : shell(shell_shapes::mapped_shell(
            [](double s, double t) -> Vec3 {
              return {0.5 * s, 0.5 * t, 0.0};
            },
            thickness, options)) {
    hold(supports, shell.nodes([](double s, double) { return at0(s); }), "xbc");
    hold(supports, shell.nodes([](double, double t) { return at0(t); }), "yac");
    hold(supports, shell.nodes([](double s, double) { return at1(s); }),
         clamped ? "xyzabc" : "za");
    hold(supports, shell.nodes([](double, double t) { return at1(t); }),
         clamped ? "xyzabc" : "zb");
  }
};

}  // namespace

double square_plate(double thickness, bool clamped, const GridOptions& options,
                    const Element& element) {
  const QuarterPlate plate(thickness, clamped, options);
  constexpr double kYoung = 1e7;
  const ShellLoads loads =
      spread(plate.shell, element,
             [](const Vec3&, const Vec3&) -> Vec3 { return Vec3::UnitZ(); });
  return solved(plate.shell, isotropic(kYoung, 0.3), plate.supports, loads,
                element)[6L * plate.shell.node(0, 0) + 2] *
         kYoung * std::pow(thickness, 3) / (12.0 * 0.91);
}

double sine_plate_energy(double thickness, const GridOptions& options,
                         const Element& element) {
  const QuarterPlate plate(thickness, false, options);
  const ShellLoads loads =
      spread(plate.shell, element, [](const Vec3& x, const Vec3&) -> Vec3 {
        return std::cos(kPi * x[0]) * std::cos(kPi * x[1]) * Vec3::UnitZ();
      });
  const double D = std::pow(thickness, 3) / (12.0 * 0.91);
  const double shear = 5.0 / 6.0 * thickness / 2.6;
  const double waves = 2.0 * kPi * kPi;
  const double top = (1.0 + waves * D / shear) / (D * waves * waves);
  return loads.nodal.dot(solved(plate.shell, isotropic(1.0, 0.3),
                                plate.supports, loads, element)) /
         (top / 16.0);
}

double twisted_beam(double thickness, double force, bool in_plane,
                    const GridOptions& options, const Element& element) {
  constexpr double kWidth = 1.1;
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double y = (t - 0.5) * kWidth;
        return {12.0 * s, y * std::cos(0.5 * kPi * s),
                y * std::sin(0.5 * kPi * s)};
      },
      thickness, options);
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return at0(s); }),
       "xyzabc");
  const Vec3 way = in_plane ? Vec3::UnitZ() : Vec3::UnitY();
  ShellLoads loads;
  if (element.corners_only) {
    loads = point_load(shell, shell.node(1, 0.5), force * way);
  } else {
    for (const auto& edge :
         shell.edges([](double s, double) { return at1(s); })) {
      loads.edges.push_back({edge, force / kWidth * way});
    }
  }
  const VectorX u =
      solved(shell, isotropic(29e6, 0.22), supports, loads, element);
  return u.segment<3>(6L * shell.node(1, 0.5)).dot(way);
}

double free_cylinder_energy(double thickness, const GridOptions& options,
                            const Element& element) {
  const MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        const double a = 0.5 * kPi * s;
        return {std::cos(a), std::sin(a), t};
      },
      thickness, options);
  std::vector<NodeSupport> supports;
  hold(supports, shell.nodes([](double s, double) { return at0(s); }), "yac");
  hold(supports, shell.nodes([](double s, double) { return at1(s); }), "xbc");
  hold(supports, shell.nodes([](double, double t) { return at0(t); }), "zab");
  const ShellLoads loads =
      spread(shell, element, [](const Vec3& x, const Vec3&) -> Vec3 {
        const Vec3 out(x[0], x[1], 0.0);
        return (x[0] * x[0] - x[1] * x[1]) / out.squaredNorm() *
               out.normalized();
      });
  return 0.5 *
         loads.nodal.dot(solved(shell, isotropic(1.0, 1.0 / 3.0), supports,
                                loads, element)) *
         std::pow(thickness, 3);
}

std::vector<double> frequencies(const ShellMesh& mesh,
                                const std::vector<Section>& sections,
                                const std::vector<NodeSupport>& supports,
                                int count) {
  const modes::NaturalModes found =
      natural_modes(mesh, sections, supports, {.count = count});
  return found.failure ? std::vector<double>() : found.frequencies;
}

std::vector<double> buckling_factors(const ShellSystem& system,
                                     const ShellLoads& loads, int count) {
  const modes::BucklingModes found =
      buckling_modes(system, loads, system.solve(loads).displacement, "loads",
                     {.count = count, .largest = 1e12});
  return found.failure ? std::vector<double>() : found.factors;
}

}  // namespace meniscus::shell_benchmarks
