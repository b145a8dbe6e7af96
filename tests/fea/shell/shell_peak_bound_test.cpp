#include "fea/shell_peaks/shell_peak_bound.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/error.h"
#include "fea/functionals/stress_criteria.h"
#include "fea/shell/shell_stress.h"
#include "fea/shell_peaks/shell_norm.h"
#include "tests/support/derivatives.h"
#include "tests/support/shell_shapes.h"

namespace meniscus::shell_peak_bound_test {
namespace {

using namespace shell;  // NOLINT: the room under test
using shell_shapes::Cut;
using shell_shapes::MappedShell;

MappedShell two_surfaces() {
  MappedShell shell = shell_shapes::mapped_shell(
      [](double s, double t) -> Vec3 {
        return {s, 1.3 * t, 0.4 * s * s - 0.3 * t * t + 0.2 * s * t};
      },
      0.08, {.m = 2, .n = 2, .cut = Cut::Mixed, .shake = 0.2});
  for (std::size_t f = 0; f < shell.mesh.section.size(); ++f) {
    shell.mesh.section[f] = f < 4 ? 0 : 1;
  }
  return shell;
}

std::vector<Section> sections() {
  element::Material fiber{"fiber", 1.0, 0.3, 1.0, {}};
  fiber.orthotropic = element::Orthotropic{
      {130.0, 9.0, 9.0}, {0.3, 0.3, 0.4}, {5.0, 5.0, 3.0}, {}};
  Section layered;
  layered.laminate.plies = {{fiber, 1.0, 0.4}, {fiber, 2.0, -0.7}};
  layered.offset = 0.3;
  layered.direction = Vec3(1.0, 0.4, 0.2);
  Section plain;
  plain.laminate.plies = {{element::Material{"plain", 20.0, 0.25, 1.0, {}}}};
  return {layered, plain};
}

VectorX six_waves(const ShellMesh& mesh, double phase) {
  VectorX v(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    v.segment<3>(at) = derivatives::wave(mesh.nodes[i], phase);
    v.segment<3>(at + 3) = derivatives::wave(mesh.nodes[i], phase + 1.0);
  }
  return v;
}

ShellLoads some_loads(const ShellMesh& mesh) {
  ShellLoads loads;
  for (int f = 0; f < static_cast<int>(mesh.facets.size()); ++f) {
    loads.pressures.push_back({f, 1.0 + 0.3 * f, WallSide::Negative});
  }
  loads.gravity = {0.5, 3.0, -9.0};
  return loads;
}

/// Two load cases on it.
struct Problem {
  MappedShell shell = two_surfaces();
  std::vector<Section> of = sections();
  ShellLoads loads = some_loads(shell.mesh);
  ShellLoads other;
  VectorX u = six_waves(shell.mesh, 0.3);
  VectorX w = six_waves(shell.mesh, 1.9);

  ShellPeakBound bound(const functionals::NodeCriterion& criterion, bool both,
                       element::Derivatives derivatives) const {
    std::vector<ShellState> states = {{loads, u}};
    if (both) {
      states.push_back({other, w});
    }
    return shell_peak_bound(
        {shell.mesh, of, shell.mesh.section, states, 0.05, derivatives},
        criterion);
  }
};

void expect_derivatives(const functionals::NodeCriterion& criterion,
                        bool both) {
  const Problem here;
  const ShellPeakBound bound =
      here.bound(criterion, both, element::Derivatives::All);
  const auto differences = [&](double exact, double scale, const auto& change) {
    derivatives::Check check;
    check.exact = exact;
    check.scale = scale;
    check.step = 2e-4;
    check.tolerance = 1e-7;
    derivatives::expect_derivative(check, [&](double h) {
      Problem moved = here;
      change(moved, h);
      return moved.bound(criterion, both, element::Derivatives::None).value;
    });
  };
  double exact = 0.0;
  double scale = 0.0;
  for (std::size_t i = 0; i < bound.by_nodes.size(); ++i) {
    const Vec3 step = derivatives::wave(here.shell.mesh.nodes[i], 0.7);
    exact += bound.by_nodes[i].dot(step);
    scale += bound.by_nodes[i].cwiseProduct(step).lpNorm<1>();
  }
  differences(exact, scale, [&](Problem& moved, double h) {
    for (std::size_t i = 0; i < bound.by_nodes.size(); ++i) {
      moved.shell.mesh.nodes[i] +=
          h * derivatives::wave(here.shell.mesh.nodes[i], 0.7);
    }
  });
  exact = 0.0;
  scale = 0.0;
  for (std::size_t f = 0; f < bound.by_thickness.size(); ++f) {
    const Vec3 step = 0.05 * derivatives::wave(here.shell.mesh.nodes[f], 0.2);
    exact += bound.by_thickness[f].dot(step);
    scale += bound.by_thickness[f].cwiseProduct(step).lpNorm<1>();
  }
  differences(exact, scale, [&](Problem& moved, double h) {
    for (std::size_t f = 0; f < bound.by_thickness.size(); ++f) {
      moved.shell.mesh.thickness[f] +=
          0.05 * h * derivatives::wave(here.shell.mesh.nodes[f], 0.2);
    }
  });
  const VectorX more = six_waves(here.shell.mesh, 1.1);
  for (std::size_t s = 0; s < bound.by_displacement.size(); ++s) {
    const VectorX& by = bound.by_displacement[s];
    differences(by.dot(more), by.cwiseProduct(more).lpNorm<1>(),
                [&](Problem& moved, double h) {
                  (s == 0 ? moved.u : moved.w) += h * more;
                });
  }
  exact = 0.3 * bound.by_ply[0][0].angle - 0.2 * bound.by_ply[0][1].angle +
          2.0 * bound.by_ply[1][0].modulus + 0.1 * bound.by_ply[0][1].modulus;
  differences(exact, std::abs(exact), [&](Problem& moved, double h) {
    std::vector<Ply>& plies = moved.of[0].laminate.plies;
    plies[0].angle += 0.3 * h;
    plies[1].angle -= 0.2 * h;
    plies[1].material.orthotropic->youngs_moduli *= 1.0 + 0.1 * h;
    plies[1].material.orthotropic->shear_moduli *= 1.0 + 0.1 * h;
    moved.of[1].laminate.plies[0].material.youngs_modulus += 2.0 * h;
  });
}

TEST(ShellPeakBound, OfVonMisesMeetsDifferences) {
  expect_derivatives(functionals::von_mises_ratio({10.0, 20.0, 8.0}), false);
}

TEST(ShellPeakBound, OfTensionMeetsDifferences) {
  expect_derivatives(functionals::tension_ratio({10.0, 20.0, 8.0}), false);
}

TEST(ShellPeakBound, OfFatigueMeetsDifferences) {
  expect_derivatives(
      functionals::goodman_ratio({{.limit = 5.0, .tensile = 9.0},
                                  {.limit = 6.0, .tensile = 8.0},
                                  {.limit = 7.0, .tensile = 7.0}}),
      true);
}

/// At or above the largest value at the nodes, by no more than the excess.
TEST(ShellPeakBound, IsJustAboveTheLargest) {
  const Problem here;
  const std::vector<double> allowable = {10.0, 20.0, 8.0};
  const double found = here.bound(functionals::von_mises_ratio(allowable),
                                  false, element::Derivatives::None)
                           .value;
  double largest = 0.0;
  visit_ply_stresses(
      here.shell.mesh, here.of, here.loads, here.u,
      [&](int ply, const std::vector<FacetStress>& stress) {
        // Surfaces are smooth: no fold of them is sharp.
        const auto mean = averaged_stress(here.shell.mesh, stress, 3.0);
        for (std::size_t f = 0; f < mean.size(); ++f) {
          const int section = here.shell.mesh.section[f];
          if (section == 1 && ply > 0) {
            continue;
          }
          const double own = allowable[section == 0 ? ply : 2];
          for (const WallStress& wall : mean[f]) {
            for (const element::Stress& s :
                 {wall.negative, wall.middle, wall.positive}) {
              largest = std::max(largest, element::von_mises(s) / own);
            }
          }
        }
      });
  EXPECT_GE(found, largest);
  EXPECT_LE(found, 1.05 * largest);
}

TEST(ShellPeakBound, RefusesAnExcessOfNone) {
  const Problem here;
  EXPECT_THROW(shell_peak_bound({here.shell.mesh,
                                 here.of,
                                 here.shell.mesh.section,
                                 {{here.loads, here.u}},
                                 0.0},
                                functionals::von_mises_ratio({1.0, 1.0, 1.0})),
               InvalidInput);
}

/// Means of exponentials, by the displacement and the thickness; towards the
/// peak as they sharpen.
TEST(ShellPeakBound, MeansOfExponentialsMeetDifferences) {
  const Problem here;
  const auto ks = [&](const ShellMesh& mesh, const VectorX& u, double sharpness,
                      NormDerivatives derivatives) {
    return von_mises_ks(mesh, here.of, here.loads, u,
                        {.sharpness = sharpness, .scale = 10.0}, derivatives);
  };
  const StressNorm found =
      ks(here.shell.mesh, here.u, 3.0, NormDerivatives::All);
  const VectorX more = six_waves(here.shell.mesh, 1.1);
  derivatives::Check check;
  check.exact = found.by_displacement.dot(more);
  check.scale = found.by_displacement.cwiseProduct(more).lpNorm<1>();
  check.step = 2e-4;
  check.tolerance = 1e-7;
  derivatives::expect_derivative(check, [&](double h) {
    return ks(here.shell.mesh, here.u + h * more, 3.0, NormDerivatives::None)
        .value;
  });
  check.exact = 0.0;
  check.scale = 0.0;
  for (const Vec3& by : found.by_thickness) {
    check.exact += 0.05 * by.sum();
    check.scale += 0.05 * by.lpNorm<1>();
  }
  derivatives::expect_derivative(check, [&](double h) {
    ShellMesh other = here.shell.mesh;
    for (Vec3& t : other.thickness) {
      t.array() += 0.05 * h;
    }
    return ks(other, here.u, 3.0, NormDerivatives::None).value;
  });
  const auto value = [&](double sharpness) {
    return ks(here.shell.mesh, here.u, sharpness, NormDerivatives::None).value;
  };
  const double norm = von_mises_norm(here.shell.mesh, here.of, here.loads,
                                     here.u, 2000.0, NormDerivatives::None)
                          .value;
  EXPECT_LT(value(1.0), value(10.0));
  EXPECT_NEAR(value(2000.0), norm, 2e-2 * norm);
  EXPECT_THROW(ks(here.shell.mesh, here.u, 0.0, NormDerivatives::None),
               InvalidInput);
}

/// A spin as a force per mass, and what its numbers change it by.
TEST(ShellPeakBound, SpinsAreForcesPerMass) {
  const Problem here;
  const loads::Spin spin{{0.2, -0.1, 0.3}, {1.0, 2.0, 3.0}, 1.7};
  const loads::Spin rates{{-0.4, 0.3, 0.1}, {0.5, -0.2, 0.7}, 0.6};
  const auto forces = [&](double h) {
    ShellLoads loads;
    loads.spin =
        loads::Spin{spin.point + h * rates.point, spin.axis + h * rates.axis,
                    spin.rate + h * rates.rate};
    return nodal_forces(here.shell.mesh, here.of, loads);
  };
  ShellLoads same;
  same.mass_force = mass_force(spin);
  EXPECT_LT((nodal_forces(here.shell.mesh, here.of, same) - forces(0.0)).norm(),
            1e-12 * forces(0.0).norm());
  ShellLoads rate;
  rate.mass_force = mass_force_rate(spin, rates);
  const VectorX v = six_waves(here.shell.mesh, 0.4);
  derivatives::Check check;
  check.exact = v.dot(nodal_forces(here.shell.mesh, here.of, rate));
  check.scale = std::abs(check.exact);
  derivatives::expect_derivative(check,
                                 [&](double h) { return v.dot(forces(h)); });
  EXPECT_THROW(mass_force(loads::Spin{{}, Vec3::Zero(), 1.0}), InvalidInput);
}

}  // namespace
}  // namespace meniscus::shell_peak_bound_test
