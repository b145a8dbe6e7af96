#include "fea/shell/facet_loads.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::shell {

namespace {

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
WholeVector pressure_forces(const Facet& facet, const FacetLoad& load) {
  const auto X = triples(facet);
  WholeVector f = WholeVector::Zero();
  for (const FacetPoint& p : facet_rule()) {
    const FacetFrame<double> frame = facet_frame(X, p, facet.direction);
    const double t = thickness_at(facet, p);
    const FacePressures acting = pressures_at(load, p);
    const auto push = [&](double pressure, double at) {
      const double zeta = (at + facet.offset) * t;
      return pressure * determinant(shifter(frame.curvature, zeta));
    };
    const double sum = push(acting.negative, -0.5) + push(acting.middle, 0.0) +
                       push(acting.positive, 0.5);
    const Vec3 force = p.weight * frame.area * sum * as_vector(frame.axes[2]);
    for (int i = 0; i < kNodes; ++i) {
      f.segment<3>(6 * i) += p.shape[i] * force;
    }
  }
  return f;
}

/// What acts along its edges; on the wall's end in the middle of the wall.
WholeVector edge_forces(const Facet& facet, const FacetLoad& load) {
  const auto X = triples(facet);
  WholeVector f = WholeVector::Zero();
  for (int e = 0; e < 3; ++e) {
    const EdgeForces& own = load.edges[e];
    if (!own.acts()) {
      continue;
    }
    for (const EdgePoint& p : edge_rules()[e]) {
      const EdgeFrame<double> frame = edge_frame(X, p);
      const Vec3 out = as_vector(frame.conormal);
      const double t = thickness_at(facet, p.at);
      const Vec3 on_end =
          p.weight * t * (out.norm() * own.traction - own.pressure * out);
      const Vec3 force = p.weight * own.pull * out + on_end;
      const Vec3 moment =
          facet.offset * t * as_vector(frame.normal).cross(on_end);
      for (int i = 0; i < kNodes; ++i) {
        f.segment<3>(6 * i) += p.at.shape[i] * force;
        f.segment<3>(6 * i + 3) += p.at.shape[i] * moment;
      }
    }
  }
  return f;
}

}  // namespace

bool has_mass_loads(const ShellLoads& loads) {
  return loads.spin || loads.mass_force || loads.gravity != Vec3::Zero();
}

Vec3 acceleration(const ShellLoads& loads, const Vec3& x) {
  Vec3 a = loads.gravity;
  if (loads.spin) {
    const Vec3 axis = loads.spin->axis.normalized();
    const Vec3 arm = x - loads.spin->point;
    a += loads.spin->rate * loads.spin->rate * (arm - axis.dot(arm) * axis);
  }
  if (loads.mass_force) {
    a += loads.mass_force->at_origin + loads.mass_force->slope * x;
  }
  return a;
}

bool FacetLoad::presses() const {
  return negative != 0.0 || middle != 0.0 || positive != 0.0 || fields;
}

bool FacetLoad::pulls() const {
  return std::any_of(edges.begin(), edges.end(),
                     [](const EdgeForces& edge) { return edge.acts(); });
}

namespace {

/// Where an edge's load adds up.
EdgeForces& edge_of(std::vector<FacetLoad>& sums, int facet, int edge,
                    const char* what) {
  const int facets = static_cast<int>(sums.size());
  if (facet < 0 || facet >= facets || edge < 0 || edge > 2) {
    throw InvalidInput(fmt::format("a {} acts on edge {} of facet {} of {}",
                                   what, edge, facet, facets));
  }
  return sums[facet].edges[edge];
}

void check_facet(int facet, int facets) {
  if (facet < 0 || facet >= facets) {
    throw InvalidInput(
        fmt::format("a pressure acts on facet {} of {}", facet, facets));
  }
}

void add_fields(const ShellMesh& mesh, const ShellLoads& loads,
                std::vector<FacetLoad>& sums) {
  std::vector<std::shared_ptr<FacetFields>> fields(
      loads.field_pressures.empty() && !loads.nodal_temperature ? 0
                                                                : sums.size());
  const auto of = [&](std::size_t facet) -> FacetFields& {
    if (!fields[facet]) {
      fields[facet] = std::make_shared<FacetFields>();
    }
    return *fields[facet];
  };
  for (const FieldPressure& load : loads.field_pressures) {
    check_facet(load.facet, static_cast<int>(sums.size()));
    FacetFields& own = of(load.facet);
    (load.side == WallSide::Positive ? own.positive : own.negative) +=
        load.pressure;
  }
  if (const auto& heat = loads.nodal_temperature) {
    for (std::size_t f = 0; f < sums.size(); ++f) {
      NodeValues& own = of(f).temperature;
      for (int i = 0; i < kNodes; ++i) {
        const int node = mesh.facets[f][i];
        own.value[i] = heat->value[node];
        own.slope[i] =
            heat->slope.empty() ? Vec3(Vec3::Zero()) : heat->slope[node];
      }
    }
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    sums[f].fields = std::move(fields[f]);
  }
}

}  // namespace

std::vector<FacetLoad> facet_loads(const ShellMesh& mesh,
                                   const ShellLoads& loads) {
  std::vector<FacetLoad> sums(mesh.facets.size());
  const int facets = static_cast<int>(mesh.facets.size());
  for (const FacetPressure& load : loads.pressures) {
    check_facet(load.facet, facets);
    FacetLoad& sum = sums[load.facet];
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
  add_fields(mesh, loads, sums);
  for (const EdgePull& load : loads.pulls) {
    edge_of(sums, load.facet, load.edge, "pull").pull += load.force;
  }
  for (const EdgeTraction& load : loads.tractions) {
    EdgeForces& sum = edge_of(sums, load.facet, load.edge, "traction");
    sum.traction += load.traction;
    sum.pressure += load.pressure;
  }
  return sums;
}

WallStates wall_states(const ShellLoads& loads, const FacetLoad& own) {
  WallState state;
  if (loads.temperature) {
    state.temperature = loads.temperature->mean;
    state.temperature_across = loads.temperature->across;
  }
  state.stress_negative = -own.negative;
  state.stress_positive = own.positive;
  return {state, own.fields.get()};
}

FacePressures pressures_at(const FacetLoad& own, const FacetPoint& p) {
  FacePressures result{own.negative, own.middle, own.positive};
  if (own.fields) {
    result.negative += own.fields->negative.at(p);
    result.positive += own.fields->positive.at(p);
  }
  return result;
}

void add_field_slopes(const Facet& facet, const FacetLoad& own,
                      const ByLoads& by_loads, double* by_places) {
  if (!own.fields) {
    return;
  }
  for (int i = 0; i < kNodes; ++i) {
    const Vec3 by = by_loads(0, i) * own.fields->temperature.slope[i] +
                    by_loads(1, i) * own.fields->negative.slope[i] +
                    by_loads(2, i) * own.fields->positive.slope[i];
    if (!by.allFinite()) {
      const Vec3& x = facet.nodes[i];
      throw InvalidInput(fmt::format(
          "a field of a load has no finite gradient at ({:.4g}, {:.4g}, "
          "{:.4g}), which derivatives ask for; take one that is smooth there",
          x.x(), x.y(), x.z()));
    }
    Eigen::Map<Vec3>(by_places + 3L * i) += by;
  }
}

WholeVector facet_forces(const Facet& facet, const ShellLoads& loads,
                         const FacetLoad& own) {
  WholeVector f = WholeVector::Zero();
  if (has_mass_loads(loads)) {
    f += mass_forces(facet, loads);
  }
  if (own.presses()) {
    f += pressure_forces(facet, own);
  }
  if (own.pulls()) {
    f += edge_forces(facet, own);
  }
  if (loads.temperature || own.presses()) {
    f += holding_forces(facet, wall_states(loads, own));
  }
  return f;
}

}  // namespace meniscus::shell
