#include "fea/shell/shell_loads.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/gauss_rule.h"
#include "core/parallel_for.h"

namespace meniscus::shell {

namespace {

/// Force per mass at a place.
Vec3 acceleration(const ShellLoads& loads, const Vec3& x) {
  Vec3 a = loads.gravity;
  if (loads.spin) {
    const Vec3 axis = loads.spin->axis.normalized();
    const Vec3 arm = x - loads.spin->point;
    a += loads.spin->rate * loads.spin->rate * (arm - axis.dot(arm) * axis);
  }
  return a;
}

/// Mass times acceleration; the latter is linear in the place.
WholeVector mass_forces(const Facet& facet, const ShellLoads& loads) {
  const auto X = triples(facet);
  const auto bubble = bubble_axes(X);
  WholeVector f = WholeVector::Zero();
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const auto m = wall_moments(facet, frame, thickness_at(facet, p));
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < kNodes; ++i) {
      x += p.shape[i] * facet.nodes[i];
    }
    const Vec3 n = as_vector(frame.axes[2]);
    const Vec3 here = acceleration(loads, x);
    const Vec3 slope = acceleration(loads, x + n) - here;
    const double area = p.weight * frame.area;
    const Vec3 force = area * (m[0] * here + m[1] * slope);
    const Vec3 moment = area * n.cross(m[1] * here + m[2] * slope);
    for (int i = 0; i < kNodes; ++i) {
      f.segment<3>(6 * i) += p.shape[i] * force;
      f.segment<3>(6 * i + 3) += p.shape[i] * moment;
    }
    for (int k = 0; k < 2; ++k) {
      f[kUnknowns + k] += p.shape[kNodes] * as_vector(bubble[k]).dot(moment);
    }
  }
  return f;
}

/// What the pressures push along the normal.
WholeVector pressure_forces(const Facet& facet, const WallPressure& load) {
  const auto X = triples(facet);
  WholeVector f = WholeVector::Zero();
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const double t = thickness_at(facet, p);
    const auto push = [&](double pressure, double at) {
      const double zeta = (at + facet.offset) * t;
      return pressure * determinant(shifter(frame.curvature, zeta));
    };
    const double sum = push(load.negative, -0.5) + push(load.middle, 0.0) +
                       push(load.positive, 0.5);
    const Vec3 force = p.weight * frame.area * sum * as_vector(frame.axes[2]);
    for (int i = 0; i < kNodes; ++i) {
      f.segment<3>(6 * i) += p.shape[i] * force;
    }
  }
  return f;
}

bool presses(const WallPressure& p) {
  return p.negative != 0.0 || p.middle != 0.0 || p.positive != 0.0;
}

void add_edge(const ShellMesh& mesh, const EdgeLoad& load, VectorX& f) {
  for (const EdgePoint& p : edge_points(mesh, load.nodes)) {
    const double length = p.weight * p.tangent.norm();
    for (int k = 0; k < 3; ++k) {
      f.segment<3>(6L * load.nodes[k]) += length * p.shape[k] * load.force;
      f.segment<3>(6L * load.nodes[k] + 3) += length * p.shape[k] * load.moment;
    }
  }
}

}  // namespace

bool has_mass_loads(const ShellLoads& loads) {
  return loads.spin.has_value() || loads.gravity != Vec3::Zero();
}

void check_loads(const ShellMesh& mesh, const ShellLoads& loads) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  for (const EdgeLoad& load : loads.edges) {
    for (const int node : load.nodes) {
      if (node < 0 || node >= nodes) {
        throw InvalidInput(fmt::format(
            "an edge load acts on node {} of a shell of {}", node, nodes));
      }
    }
  }
  if (loads.spin && !(loads.spin->axis.norm() > 0.0)) {
    throw InvalidInput("the spin of a shell has an axis without length");
  }
  if (loads.nodal.size() != 0 && loads.nodal.size() != 6L * nodes) {
    throw InvalidInput(
        fmt::format("a shell of {} nodes has {} nodal forces and moments; give "
                    "six a node",
                    nodes, loads.nodal.size()));
  }
}

std::array<EdgePoint, 3> edge_points(const ShellMesh& mesh,
                                     const std::array<int, 3>& nodes) {
  std::array<EdgePoint, 3> points;
  const std::vector<GaussPoint> rule = gauss_rule(3);
  for (int q = 0; q < 3; ++q) {
    const double s = rule[q].at;
    EdgePoint& p = points[q];
    p.weight = rule[q].weight;
    p.shape = {(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0),
               4.0 * s * (1.0 - s)};
    p.slope = {4.0 * s - 3.0, 4.0 * s - 1.0, 4.0 - 8.0 * s};
    p.tangent = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      p.tangent += p.slope[k] * mesh.nodes[nodes[k]];
    }
  }
  return points;
}

std::vector<WallPressure> wall_pressures(const ShellMesh& mesh,
                                         const ShellLoads& loads) {
  std::vector<WallPressure> sums(mesh.facets.size());
  const int facets = static_cast<int>(mesh.facets.size());
  for (const FacetPressure& load : loads.pressures) {
    if (load.facet < 0 || load.facet >= facets) {
      throw InvalidInput(
          fmt::format("a pressure acts on facet {} of {}", load.facet, facets));
    }
    WallPressure& sum = sums[load.facet];
    switch (load.side) {
      case WallSide::Negative:
        sum.negative += load.pressure;
        break;
      case WallSide::Middle:
        sum.middle += load.pressure;
        break;
      case WallSide::Positive:
        sum.positive += load.pressure;
        break;
    }
  }
  return sums;
}

WallState wall_state(const ShellLoads& loads, const WallPressure& pressure) {
  WallState state;
  if (loads.temperature) {
    state.temperature = loads.temperature->mean;
    state.temperature_across = loads.temperature->across;
  }
  state.stress_negative = -pressure.negative;
  state.stress_positive = pressure.positive;
  return state;
}

WholeVector facet_forces(const Facet& facet, const ShellLoads& loads,
                         const WallPressure& pressure) {
  WholeVector f = WholeVector::Zero();
  if (has_mass_loads(loads)) {
    f += mass_forces(facet, loads);
  }
  if (presses(pressure)) {
    f += pressure_forces(facet, pressure);
  }
  if (loads.temperature || presses(pressure)) {
    f += holding_forces(facet, wall_state(loads, pressure));
  }
  return f;
}

VectorX nodal_forces(const ShellMesh& mesh,
                     const std::vector<Section>& sections,
                     const ShellLoads& loads) {
  check_loads(mesh, loads);
  VectorX f = loads.nodal;
  if (f.size() == 0) {
    f = VectorX::Zero(static_cast<Eigen::Index>(6 * mesh.nodes.size()));
  }
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const std::vector<WallPressure> pressures = wall_pressures(mesh, loads);
  const bool everywhere = has_mass_loads(loads) || loads.temperature;
  std::vector<FacetVector> forces(mesh.facets.size(), FacetVector::Zero());
  parallel_for(static_cast<std::ptrdiff_t>(forces.size()),
               [&](std::ptrdiff_t k) {
                 if (everywhere || presses(pressures[k])) {
                   const Facet facet =
                       facet_of(mesh, sections, laws, static_cast<int>(k));
                   WholeVector whole = facet_forces(facet, loads, pressures[k]);
                   condensed(whole_stiffness(facet), &whole);
                   forces[k] = whole.head<kUnknowns>();
                 }
               });
  for (std::size_t k = 0; k < forces.size(); ++k) {
    for (int i = 0; i < kNodes; ++i) {
      f.segment<6>(6L * mesh.facets[k][i]) += forces[k].segment<6>(6 * i);
    }
  }
  for (const EdgeLoad& load : loads.edges) {
    add_edge(mesh, load, f);
  }
  return f;
}

}  // namespace meniscus::shell
