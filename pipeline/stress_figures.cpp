#include "pipeline/stress_figures.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "fea/body_loads.h"

namespace meniscus {

namespace {

using Json = nlohmann::ordered_json;

Json place_json(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

Json uniformity_json(const Uniformity& u) {
  return {{"mean", u.mean},
          {"coefficient_of_variation", u.coefficient_of_variation},
          {"gini", u.gini},
          {"p05", u.p05},
          {"p50", u.p50},
          {"p95", u.p95},
          {"p95_over_p50", u.p95_over_p50},
          {"peak", u.peak},
          {"peak_over_mean", u.peak_over_mean},
          {"histogram", u.histogram}};
}

StressFigures figures_of(const EvaluationFields& fields,
                         std::size_t load_case) {
  const TetMesh& mesh = fields.mesh;
  const auto& materials = fields.inputs.materials;
  const LoadCase& loads = fields.inputs.load_cases[load_case];
  const PointStress points =
      point_stress(mesh, materials, fields.solution.displacements[load_case],
                   temperature_change(mesh, loads));
  const RecoveredStress recovered = recover_by_patches(mesh, points);
  const StressField nodal = nodal_stress(mesh, recovered);
  StressFigures figures{
      .load_case = loads.name,
      .max_von_mises = nodal.max_von_mises,
      .position = mesh.nodes[static_cast<std::size_t>(nodal.max_node)]};
  const SafetyFactors safety = safety_factors(mesh, materials, recovered);
  if (std::isfinite(safety.smallest)) {
    const Material& weakest =
        materials[static_cast<std::size_t>(safety.region)];
    figures.safety = StressFigures::Safety{
        .factor = safety.smallest,
        .von_mises = safety.von_mises,
        .position = mesh.nodes[static_cast<std::size_t>(safety.node)],
        .material = weakest.name,
        .yield_strength = *weakest.yield_strength};
  }
  figures.uniformity = stress_uniformity(mesh, materials, points);
  return figures;
}

}  // namespace

std::vector<StressFigures> stress_figures(const EvaluationFields& fields) {
  std::vector<StressFigures> figures;
  for (std::size_t k = 0; k < fields.inputs.load_cases.size(); ++k) {
    figures.push_back(figures_of(fields, k));
  }
  return figures;
}

Json stress_json(const std::vector<StressFigures>& figures) {
  Json json = Json::object();
  for (const StressFigures& f : figures) {
    Json entry = {{"max_von_mises", f.max_von_mises},
                  {"position", place_json(f.position)}};
    if (f.safety) {
      entry["safety_factor"] = {{"smallest", f.safety->factor},
                                {"von_mises", f.safety->von_mises},
                                {"position", place_json(f.safety->position)},
                                {"material", f.safety->material}};
    }
    entry["von_mises"] = uniformity_json(f.uniformity.von_mises);
    entry["energy_density"] = uniformity_json(f.uniformity.energy_density);
    json[f.load_case] = std::move(entry);
  }
  return json;
}

}  // namespace meniscus
