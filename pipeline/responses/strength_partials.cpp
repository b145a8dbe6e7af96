#include <utility>
#include <vector>

#include "fea/functionals/nodal_peak.h"
#include "fea/functionals/stress_criteria.h"
#include "fea/shell_peaks/shell_peak_bound.h"
#include "pipeline/responses/response_partials.h"

namespace meniscus::responses {

namespace {

/// Of the load cases, in the states' order.
ResponsePartials peak_partials(functionals::NodalPeak peak,
                               const std::vector<int>& load_cases,
                               const ResponseTask& task) {
  ResponsePartials result;
  if (task.response.worst_in) {
    result.worst_direction = functionals::worst_stress_direction(
        peak.largest, *task.response.worst_in);
  }
  result.value = peak.value;
  result.by_nodes = std::move(peak.by_nodes);
  result.by_modulus = std::move(peak.by_modulus);
  for (std::size_t s = 0; s < peak.states.size(); ++s) {
    result.cases.push_back(
        {.load_case = load_cases[s],
         .by_displacement = std::move(peak.states[s].by_displacement),
         .by_forces = {},
         .by_temperature = std::move(peak.states[s].by_temperature)});
  }
  return result;
}

ResponsePartials shell_peak_partials(
    const ResponseTask& task, const std::vector<int>& load_cases,
    const functionals::NodeCriterion& criterion) {
  const shells::ShellPart& part = *task.fields.shell;
  std::vector<shell::ShellState> states;
  states.reserve(load_cases.size());
  for (const int c : load_cases) {
    const shells::ShellCase& own = part.cases[static_cast<std::size_t>(c)];
    states.push_back({own.actions.loads, own.displacement});
  }
  shell::ShellPeakBound bound = shell::shell_peak_bound(
      {part.mesh, part.sections, part.skin.face_label, std::move(states),
       task.response.excess, task.derivatives},
      criterion);
  std::vector<VectorX> by_displacement = std::move(bound.by_displacement);
  std::vector<shell::ActionGradient> by_actions =
      std::move(bound.by_state_actions);
  ResponsePartials result = shell_to_partials(part, std::move(bound));
  for (std::size_t s = 0; s < by_displacement.size(); ++s) {
    result.cases.push_back({.load_case = load_cases[s],
                            .by_displacement = std::move(by_displacement[s]),
                            .by_forces = {},
                            .by_temperature = {}});
    if (!by_actions.empty()) {
      result.cases.back().by_actions = std::move(by_actions[s]);
    }
  }
  return result;
}

}  // namespace

ResponsePartials nodal_peak_partials(
    const ResponseTask& task, const std::vector<int>& load_cases,
    const functionals::NodeCriterion& criterion) {
  const ResponseContext& fields = task.fields;
  if (fields.shell != nullptr) {
    return shell_peak_partials(task, load_cases, criterion);
  }
  std::vector<functionals::StressState> states;
  states.reserve(load_cases.size());
  for (const int c : load_cases) {
    states.push_back({fields.inputs.load_cases[static_cast<std::size_t>(c)],
                      fields.solution.displacements[c]});
  }
  return peak_partials(
      functionals::nodal_peak(
          {fields.mesh, task.fields.inputs.materials, std::move(states),
           fields.excluded, task.response.excess, task.derivatives},
          criterion),
      load_cases, task);
}

std::vector<double> allowable_stress(const ResponseTask& task) {
  std::vector<double> allowable;
  allowable.reserve(task.fields.inputs.materials.size());
  for (const element::Material& material : task.fields.inputs.materials) {
    allowable.push_back(task.response.allowable
                            ? *task.response.allowable
                            : material.yield_strength.value());
  }
  return allowable;
}

ResponsePartials stress_ratio(const ResponseTask& task) {
  return nodal_peak_partials(
      task, {task.response.load_case},
      task.response.stress == case_data::StressMeasure::VonMises
          ? functionals::von_mises_ratio(allowable_stress(task))
          : functionals::tension_ratio(allowable_stress(task)));
}

ResponsePartials fatigue(const ResponseTask& task) {
  std::vector<functionals::Endurance> endurance;
  endurance.reserve(task.fields.inputs.materials.size());
  for (const element::Material& material : task.fields.inputs.materials) {
    endurance.push_back({.limit = material.endurance_limit.value(),
                         .tensile = material.tensile_strength.value_or(0.0),
                         .torsion = material.torsion_limit.value_or(0.0)});
  }
  return nodal_peak_partials(
      task, task.response.load_cases,
      task.response.criterion == case_data::FatigueCriterion::Goodman
          ? functionals::goodman_ratio(std::move(endurance))
          : functionals::crossland_ratio(std::move(endurance)));
}

}  // namespace meniscus::responses
