#include "pipeline/forward/stress_figures.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/count_text.h"
#include "pipeline/files/place_json.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

Json uniformity_json(const stress::Uniformity& u) {
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

std::optional<StressFigures::Safety> safety_of(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const stress::RecoveredStress& recovered,
    const element::PointStress& points, const std::vector<char>& excluded) {
  const stress::SafetyFactor safety =
      stress::safety_factor(mesh, materials, recovered, points, excluded);
  if (!std::isfinite(safety.smallest)) {
    return std::nullopt;
  }
  const element::Material& weakest =
      materials[static_cast<std::size_t>(safety.region)];
  return StressFigures::Safety{.factor = safety.smallest,
                               .von_mises = safety.von_mises,
                               .position = safety.position,
                               .material = weakest.name,
                               .yield_strength = *weakest.yield_strength};
}

std::vector<char> complement(std::vector<char> excluded) {
  for (char& e : excluded) {
    e = e == 0 ? 1 : 0;
  }
  return excluded;
}

/// All but how even the stress is.
StressFigures peaks_of(const EvaluationFields& fields, std::size_t load_case) {
  const TetMesh& mesh = fields.mesh;
  const auto& materials = fields.inputs.materials;
  const loads::LoadCase& loads = fields.inputs.load_cases[load_case];
  const std::vector<char>& excluded = fields.exclusion.element;
  const element::PointStress& points = fields.stresses[load_case].points;
  const stress::RecoveredStress& recovered =
      fields.stresses[load_case].recovered;
  stress::StressField nodal = stress::nodal_stress(mesh, recovered);
  const auto place = [&] {
    return mesh.nodes[static_cast<std::size_t>(nodal.max_node)];
  };
  StressFigures figures{.load_case = loads.name};
  if (fields.exclusion.all.elements > 0) {
    const std::vector<char> counted = complement(excluded);
    stress::find_peak(mesh, counted, nodal);
    figures.excluded = StressFigures::Excluded{
        nodal.max_von_mises, place(),
        safety_of(mesh, materials, recovered, points, counted)};
    stress::find_peak(mesh, excluded, nodal);
  }
  figures.max_von_mises = nodal.max_von_mises;
  figures.readings = stress::peak_readings(mesh, recovered, points, excluded);
  figures.position = place();
  figures.safety = safety_of(mesh, materials, recovered, points, excluded);
  return figures;
}

StressFigures figures_of(const EvaluationFields& fields,
                         std::size_t load_case) {
  StressFigures figures = peaks_of(fields, load_case);
  figures.uniformity = stress::stress_uniformity(
      fields.mesh, fields.inputs.materials, fields.stresses[load_case].points,
      fields.exclusion.element);
  return figures;
}

bool is_worse(const StressFigures& a, const StressFigures& b) {
  if (a.safety && b.safety) {
    return a.safety->factor < b.safety->factor;
  }
  return a.safety.has_value() == b.safety.has_value()
             ? a.max_von_mises > b.max_von_mises
             : a.safety.has_value();
}

Json safety_json(const StressFigures::Safety& safety) {
  return {{"smallest", safety.factor},
          {"von_mises", safety.von_mises},
          {"position", files::place_json(safety.position)},
          {"material", safety.material}};
}

}  // namespace

std::vector<StressFigures> stress_figures(const EvaluationFields& fields) {
  std::vector<StressFigures> figures;
  for (std::size_t k = 0; k < fields.inputs.load_cases.size(); ++k) {
    figures.push_back(figures_of(fields, k));
  }
  return figures;
}

std::size_t worst_load_case(const std::vector<StressFigures>& figures) {
  std::size_t worst = 0;
  for (std::size_t k = 1; k < figures.size(); ++k) {
    if (is_worse(figures[k], figures[worst])) {
      worst = k;
    }
  }
  return worst;
}

std::size_t worst_load_case(const EvaluationFields& fields) {
  std::vector<StressFigures> figures;
  for (std::size_t k = 0; k < fields.inputs.load_cases.size(); ++k) {
    figures.push_back(peaks_of(fields, k));
  }
  return worst_load_case(figures);
}

std::string stress_text(const std::vector<StressFigures>& figures,
                        const UnitSystem& units) {
  std::string text;
  const std::size_t worst = worst_load_case(figures);
  for (std::size_t k = 0; k < figures.size(); ++k) {
    const StressFigures& f = figures[k];
    const Vec3& at = f.position;
    text += fmt::format(
        "  peak stress, {:<8} {} at ({:.4g}, {:.4g}, {:.4g})", f.load_case,
        quantity_text(f.max_von_mises, units.pressure), at.x(), at.y(), at.z());
    if (f.safety) {
      text += fmt::format(", safety {:.3g}", f.safety->factor);
    }
    text += figures.size() > 1 && k == worst ? "   <- the worst\n" : "\n";
  }
  return text;
}

Json stress_json(const std::vector<StressFigures>& figures) {
  Json json = Json::object();
  for (const StressFigures& f : figures) {
    Json entry = {{"max_von_mises", f.max_von_mises},
                  {"position", files::place_json(f.position)},
                  {"readings",
                   {{"recovered", f.readings.recovered},
                    {"averaged", f.readings.averaged},
                    {"points", f.readings.points}}}};
    if (f.safety) {
      entry["safety_factor"] = safety_json(*f.safety);
    }
    if (f.excluded) {
      entry["excluded"] = {
          {"max_von_mises", f.excluded->max_von_mises},
          {"position", files::place_json(f.excluded->position)}};
      if (f.excluded->safety) {
        entry["excluded"]["safety_factor"] = safety_json(*f.excluded->safety);
      }
    }
    entry["von_mises"] = uniformity_json(f.uniformity.von_mises);
    entry["energy_density"] = uniformity_json(f.uniformity.energy_density);
    json[f.load_case] = std::move(entry);
  }
  return json;
}

}  // namespace meniscus::forward
