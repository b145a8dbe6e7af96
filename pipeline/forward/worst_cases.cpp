#include "pipeline/forward/worst_cases.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "fea/functionals/nodal_peak.h"
#include "fea/functionals/stress_criteria.h"
#include "pipeline/forward/shell_figures.h"
#include "pipeline/responses/worst_loads.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

std::vector<double> stress_to_compare_with(
    const std::vector<element::Material>& materials) {
  std::vector<double> stress;
  stress.reserve(materials.size());
  const bool all_yield = std::ranges::all_of(
      materials,
      [](const element::Material& m) { return bool(m.yield_strength); });
  for (const element::Material& material : materials) {
    stress.push_back(all_yield ? *material.yield_strength : 1.0);
  }
  return stress;
}

/// Of the states of three unit loads, which begin at `first`.
Vec3 direction_of_most_stress(const EvaluationFields& fields, int first,
                              const Cone& cone) {
  std::vector<functionals::StressState> states;
  states.reserve(3);
  for (int k = first; k < first + 3; ++k) {
    states.push_back(
        {fields.inputs.load_cases[k], fields.solution.displacements[k]});
  }
  const functionals::NodalPeak peak = functionals::nodal_peak(
      {.mesh = fields.mesh,
       .materials = fields.inputs.materials,
       .states = std::move(states),
       .excluded = fields.exclusion.what,
       .derivatives = element::Derivatives::None},
      functionals::worst_von_mises_ratio(
          stress_to_compare_with(fields.inputs.materials), cone));
  return functionals::worst_stress_direction(peak.largest, cone);
}

loads::LoadCase worst_case(const std::vector<loads::LoadCase>& load_cases,
                           const case_data::DirectionsEntry& load,
                           const Vec3& d) {
  loads::LoadCase worst = responses::combined_load(load_cases, load.first, d);
  worst.name = load.name;
  return worst;
}

}  // namespace

void find_stresses(const case_data::Case& input, EvaluationFields& fields) {
  for (const case_data::DirectionsEntry& load : input.directions) {
    const Vec3 d = direction_of_most_stress(fields, load.first, load.cone);
    fields.worst_cases.push_back(
        {static_cast<int>(fields.inputs.load_cases.size()), load.first, d});
    fields.inputs.load_cases.push_back(
        worst_case(fields.inputs.load_cases, load, d));
    fields.solution.displacements.push_back(
        responses::combined(fields.solution.displacements, load.first, d));
    fields.solution.reactions.push_back(
        responses::combined(fields.solution.reactions, load.first, d));
  }
  if (fields.shell) {
    return find_shell_stresses(*fields.shell);
  }
  fields.stresses = part_stresses(fields.mesh, fields.inputs, fields.solution);
}

void add_worst_cases(const case_data::Case& input,
                     const nlohmann::ordered_json& result,
                     case_data::EvaluatedCase& inputs) {
  for (const case_data::DirectionsEntry& load : input.directions) {
    const Json::json_pointer at("/stress/" + load.name + "/direction");
    if (result.contains(at)) {
      const auto d = result[at].get<std::array<double, 3>>();
      inputs.load_cases.push_back(
          worst_case(inputs.load_cases, load, Vec3(d[0], d[1], d[2])));
    }
  }
}

bool is_unit_load(const EvaluationFields& fields, std::size_t load_case) {
  const auto k = static_cast<int>(load_case);
  return std::ranges::any_of(fields.worst_cases, [&](const WorstCase& worst) {
    return k >= worst.first && k < worst.first + 3;
  });
}

std::vector<loads::LoadCase> solved_load_cases(const EvaluationFields& fields) {
  const std::vector<loads::LoadCase>& all = fields.inputs.load_cases;
  return {all.begin(),
          all.end() - static_cast<std::ptrdiff_t>(fields.worst_cases.size())};
}

}  // namespace meniscus::forward
