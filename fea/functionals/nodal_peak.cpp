#include "fea/functionals/nodal_peak.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "fea/element/point_covector.h"
#include "fea/element/point_stress.h"
#include "fea/loads/body_loads.h"
#include "fea/stress/averaged_stress.h"
#include "fea/stress/patch_recovery.h"

namespace meniscus::functionals {

namespace {

constexpr int kReadings = 2;  // by patches, by averages

/// One state's stresses at the points and, in both readings, at the nodes.
struct NodalState {
  element::PointStress points;
  std::array<stress::RecoveredStress, kReadings> reading;
};

/// All states, and which copies of nodes count.
struct Nodes {
  std::vector<NodalState> states;
  std::vector<int> region;  // of each copy; -1: does not count
  int count = 0;            // of those that do

  const element::RegionNodes& copies() const {
    return states.front().reading.front().nodes;
  }
};

Nodes read_nodes(const NodalPeakInput& in) {
  Nodes nodes;
  nodes.states.reserve(in.states.size());
  for (const StressState& state : in.states) {
    NodalState here;
    here.points = element::point_stress(
        in.mesh, in.materials, state.displacement,
        loads::temperature_change(in.mesh, state.load_case));
    here.reading = {stress::recover_by_patches(in.mesh, here.points),
                    stress::average_extrapolations(in.mesh, here.points)};
    nodes.states.push_back(std::move(here));
  }
  const element::RegionNodes& copies = nodes.copies();
  nodes.region.assign(static_cast<std::size_t>(copies.count()), -1);
  for (int e = 0; e < in.mesh.element_count(); ++e) {
    for (const int copy : copies.element(e)) {
      if (in.excluded.counts(e, copies.node[copy])) {
        nodes.region[copy] = in.mesh.element_region[e];
      }
    }
  }
  nodes.count =
      static_cast<int>(std::count_if(nodes.region.begin(), nodes.region.end(),
                                     [](int region) { return region >= 0; }));
  if (nodes.count == 0) {
    throw InvalidInput(
        "nodal peak: no node counts; the exclusion zones cover the whole "
        "part");
  }
  return nodes;
}

/// The states' stresses of one copy in one reading.
void gather(const Nodes& nodes, int reading, int copy,
            std::vector<element::Stress>& stress) {
  for (std::size_t s = 0; s < nodes.states.size(); ++s) {
    stress[s] = nodes.states[s].reading[reading].value[copy];
  }
}

using Values = std::array<std::vector<double>, kReadings>;

/// Of every copy; 0 where it does not count or is below 0.
Values values_of(const Nodes& nodes, const NodeCriterion& criterion,
                 double power) {
  const int copies = nodes.copies().count();
  Values values;
  for (int r = 0; r < kReadings; ++r) {
    values[r].assign(static_cast<std::size_t>(copies), 0.0);
#pragma omp parallel
    {
      std::vector<element::Stress> stress(nodes.states.size());
#pragma omp for schedule(static)
      for (int i = 0; i < copies; ++i) {
        if (nodes.region[i] >= 0) {
          gather(nodes, r, i, stress);
          values[r][i] = std::max(
              0.0, criterion.value(nodes.region[i], power, stress, {}));
        }
      }
    }
  }
  return values;
}

/// What the bound changes by the nodal stresses of each state in one reading.
std::vector<std::vector<element::Stress>> by_nodal_stress(
    const Nodes& nodes, const NodeCriterion& criterion, double power,
    const std::vector<double>& values, int reading, double bound) {
  constexpr double kNothing = 1e-14;  // of the largest: 0 to rounding
  const auto states = nodes.states.size();
  const int copies = nodes.copies().count();
  std::vector<std::vector<element::Stress>> by(
      states, std::vector<element::Stress>(static_cast<std::size_t>(copies),
                                           element::Stress{}));
#pragma omp parallel
  {
    std::vector<element::Stress> stress(states);
    std::vector<element::Stress> slope(states);
#pragma omp for schedule(static)
    for (int i = 0; i < copies; ++i) {
      const double weight =
          bound > 0.0 ? std::pow(values[i] / bound, power - 1.0) : 0.0;
      if (weight < kNothing) {
        continue;
      }
      gather(nodes, reading, i, stress);
      std::fill(slope.begin(), slope.end(), element::Stress{});
      criterion.value(nodes.region[i], power, stress, slope);
      for (std::size_t s = 0; s < states; ++s) {
        element::add_scaled(weight, slope[s], by[s][i]);
      }
    }
  }
  return by;
}

/// The symmetric tensor A with A : dS = by . dS.
Mat3 tensor_of(const element::Stress& by) {
  Mat3 A;
  A << by[0], 0.5 * by[3], 0.5 * by[5], 0.5 * by[3], by[1], 0.5 * by[4],
      0.5 * by[5], 0.5 * by[4], by[2];
  return A;
}

/// Adds what one state's points change the bound by.
void add_state(const NodalPeakInput& in, std::size_t s, const NodalState& state,
               const element::PointCovector& by, NodalPeak& peak) {
  element::Functional part;
  chain_points(
      in.mesh, in.materials, in.states[s],
      [&](int e, int q) -> PointSlope {
        const std::size_t at = state.points.index(e, q);
        return {.stress = tensor_of(by.stress[at]),
                .position = by.position[at],
                .volume = by.volume[at],
                .is_zero = element::is_zero(by.stress[at]) &&
                           by.position[at].isZero(0.0) && by.volume[at] == 0.0};
      },
      part);
  for (std::size_t i = 0; i < part.by_nodes.size(); ++i) {
    peak.by_nodes[i] += part.by_nodes[i] + by.nodes[i];
  }
  // At a given strain stress is in proportion to Young's modulus.
  for (std::size_t at = 0; at < by.stress.size(); ++at) {
    const int e = static_cast<int>(at) / state.points.points_per_element;
    const int region = in.mesh.element_region[e];
    if (!in.materials[region].orthotropic) {
      peak.by_modulus[region] +=
          element::dot(by.stress[at], state.points.stress[at]) /
          in.materials[region].youngs_modulus;
    }
  }
  peak.states.push_back(
      {std::move(part.by_displacement), std::move(part.by_temperature)});
}

void differentiate_peak(const NodalPeakInput& in, const Nodes& nodes,
                        const NodeCriterion& criterion, double power,
                        const Values& values, NodalPeak& peak) {
  // 1. Backwards from the bound to both readings' stresses.
  std::vector<element::PointCovector> by;
  by.reserve(nodes.states.size());
  for (const NodalState& state : nodes.states) {
    by.emplace_back(in.mesh, state.points);
  }
  for (int r = 0; r < kReadings; ++r) {
    const auto slopes =
        by_nodal_stress(nodes, criterion, power, values[r], r, peak.value);
    for (std::size_t s = 0; s < nodes.states.size(); ++s) {
      const NodalState& state = nodes.states[s];
      if (r == 0) {
        stress::transpose_patches(in.mesh, state.points, nodes.copies(),
                                  slopes[s], by[s]);
      } else {
        stress::transpose_averages(state.reading[r], state.points, slopes[s],
                                   by[s]);
      }
    }
  }
  // 2. From the points on.
  peak.by_nodes.assign(in.mesh.nodes.size(), Vec3::Zero());
  peak.by_modulus.assign(in.materials.size(), 0.0);
  for (std::size_t s = 0; s < nodes.states.size(); ++s) {
    add_state(in, s, nodes.states[s], by[s], peak);
  }
}

}  // namespace

NodalPeak nodal_peak(const NodalPeakInput& input,
                     const NodeCriterion& criterion) {
  if (!(input.excess > 0.0) || !(input.excess < 1.0)) {
    throw InvalidInput(fmt::format(
        "nodal peak: the bound may be {} of the largest value above it; "
        "expected a part between 0 and 1",
        input.excess));
  }
  constexpr double kLeastPower = 4.0;  // second derivatives where v begins
  const Nodes nodes = read_nodes(input);
  const double numbers =
      static_cast<double>(nodes.count) * kReadings * criterion.terms;
  const double power =
      std::max(kLeastPower, std::log(numbers) / std::log1p(input.excess));
  const Values values = values_of(nodes, criterion, power);
  NodalPeak peak;
  peak.largest.resize(nodes.states.size());
  double largest = -1.0;
  for (int r = 0; r < kReadings; ++r) {
    const auto at = std::max_element(values[r].begin(), values[r].end());
    if (*at > largest) {
      largest = *at;
      gather(nodes, r, static_cast<int>(at - values[r].begin()), peak.largest);
    }
  }
  double sum = 0.0;
  for (const std::vector<double>& reading : values) {
    for (const double value : reading) {
      sum += value > 0.0 ? std::pow(value / largest, power) : 0.0;
    }
  }
  peak.value = largest > 0.0 ? largest * std::pow(sum, 1.0 / power) : 0.0;
  if (input.derivatives == element::Derivatives::All) {
    differentiate_peak(input, nodes, criterion, power, values, peak);
  }
  return peak;
}

}  // namespace meniscus::functionals
