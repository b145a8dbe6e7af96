#include "pipeline/forward/stress_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/count_text.h"
#include "fea/stress/averaged_stress.h"
#include "pipeline/files/place_json.h"
#include "pipeline/forward/shell_figures.h"
#include "pipeline/forward/singular_places.h"
#include "pipeline/forward/worst_cases.h"
#include "pipeline/responses/worst_loads.h"

namespace meniscus::forward {

namespace {

using Json = nlohmann::ordered_json;

// Of the peak, on edges kShorterEdges times shorter.
constexpr double kNoLimit = 0.05;

double degrees(double angle) { return angle * 180.0 / std::numbers::pi; }

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
    const stress::StressReadings& stress,
    const std::vector<element::Material>& materials,
    const stress::Excluded& excluded) {
  const stress::SafetyFactor safety =
      stress::safety_factor(stress, materials, excluded);
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

/// All but how even the stress is.
StressFigures peaks_of(const EvaluationFields& fields, std::size_t load_case) {
  if (fields.shell) {
    return shell_figures(fields, load_case);
  }
  const auto& materials = fields.inputs.materials;
  const stress::Excluded& excluded = fields.exclusion.what;
  const PartStress& found = fields.stresses[load_case];
  const stress::RecoveredStress averaged =
      stress::average_extrapolations(fields.mesh, found.points);
  const stress::StressReadings stress{fields.mesh, found.recovered, averaged,
                                      found.points};
  StressFigures figures{.load_case = fields.inputs.load_cases[load_case].name,
                        .readings = stress::peak_readings(stress, excluded),
                        .safety = safety_of(stress, materials, excluded)};
  figures.is_unit_load = is_unit_load(fields, load_case);
  for (const WorstCase& worst : fields.worst_cases) {
    if (worst.load_case == static_cast<int>(load_case)) {
      figures.direction = worst.direction;
    }
  }
  figures.max_von_mises = figures.readings.recovered.von_mises;
  figures.position = figures.readings.recovered.position;
  stress::Excluded left_out = excluded;
  left_out.inverted = true;
  const stress::Peak peak =
      stress::peak_of(fields.mesh, found.recovered, left_out);
  if (peak.von_mises > 0.0) {
    figures.excluded = StressFigures::Excluded{
        peak.von_mises, peak.position, safety_of(stress, materials, left_out)};
  }
  return figures;
}

std::optional<StressFigures::Singular> singular_place(
    const EvaluationFields& fields, std::size_t load_case) {
  const TetMesh& mesh = fields.mesh;
  const std::optional<stress::SingularPeak> peak =
      stress::largest_singular_peak(mesh, singular_edges_of(fields, load_case),
                                    fields.stresses[load_case].recovered,
                                    fields.exclusion.what, kShorterEdges);
  if (!peak) {
    return std::nullopt;
  }
  const auto surface = [&](std::size_t k) {
    return mesh.labels[static_cast<std::size_t>(peak->edge.labels[k])];
  };
  return StressFigures::Singular{.position = peak->position,
                                 .von_mises = peak->von_mises,
                                 .grown = peak->grown,
                                 .surfaces = {surface(0), surface(1)},
                                 .clamped = peak->edge.clamped,
                                 .angle = peak->edge.angle,
                                 .order = peak->edge.order};
}

StressFigures figures_of(const EvaluationFields& fields,
                         std::size_t load_case) {
  StressFigures figures = peaks_of(fields, load_case);
  if (fields.shell) {
    return figures;
  }
  figures.singular = singular_place(fields, load_case);
  figures.uniformity = stress::stress_uniformity(
      fields.mesh, fields.inputs.materials, fields.stresses[load_case].points,
      fields.exclusion.what.element);
  return figures;
}

bool is_worse(const StressFigures& a, const StressFigures& b) {
  if (a.is_unit_load != b.is_unit_load) {
    return b.is_unit_load;
  }
  if (a.safety && b.safety) {
    return a.safety->factor < b.safety->factor;
  }
  return a.safety.has_value() == b.safety.has_value()
             ? a.max_von_mises > b.max_von_mises
             : a.safety.has_value();
}

/// " (of 72 MPa, its highest reading; 1.9 with the +-)".
std::string safety_text(const StressFigures& figures, const UnitSystem& units) {
  constexpr double kOther = 1.01;  // x the peak told: another reading's
  std::vector<std::string> parts;
  if (figures.safety->von_mises > kOther * figures.max_von_mises) {
    parts.push_back(
        "of " + quantity_text(figures.safety->von_mises, units.pressure, 4) +
        ", the highest reading");
  }
  if (const auto least = safety_with_error(figures)) {
    parts.push_back(fmt::format("{:.3g} with the +-", *least));
  }
  return parts.empty() ? "" : fmt::format(" ({})", fmt::join(parts, "; "));
}

Json no_limit_json(const StressFigures::Singular& singular) {
  return {{"position", files::place_json(singular.position)},
          {"von_mises", singular.von_mises},
          {"surfaces", singular.surfaces},
          {"clamped", singular.clamped},
          {"angle_deg", degrees(singular.angle)},
          {"order", singular.order}};
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

std::vector<double> highest_readings(const EvaluationFields& fields) {
  std::vector<double> peaks;
  for (std::size_t k = 0; k < fields.inputs.load_cases.size(); ++k) {
    peaks.push_back(peaks_of(fields, k).readings.largest().von_mises);
  }
  return peaks;
}

double growth_of_peak(const StressFigures& figures) {
  return figures.singular
             ? std::max(0.0, figures.singular->grown - figures.max_von_mises)
             : 0.0;
}

double extrapolated_part(const StressFigures& figures) {
  return figures.readings.largest().von_mises -
         figures.readings.points.von_mises;
}

bool may_be_singular(const EvaluationFields& fields,
                     const StressFigures& figures) {
  const auto& materials = fields.inputs.materials;
  const auto differs = [&](const element::Material& material) {
    return material.name != materials.front().name;
  };
  return growth_of_peak(figures) > 0.0 ||
         std::ranges::any_of(materials, differs);
}

bool has_no_limit(const StressFigures& figures) {
  return growth_of_peak(figures) > kNoLimit * figures.max_von_mises;
}

std::string no_limit_text(const StressFigures& figures,
                          const UnitSystem& units) {
  const StressFigures::Singular& s = *figures.singular;
  return fmt::format(
      "the peak stress of '{}' has no limit: at ({:.4g}, {:.4g}, {:.4g}) {}, "
      "{:.0f} degrees of material, and stress ({} there) grows by {:.0f} % "
      "whenever edges are halved; the +- looks ahead to edges {:g} times "
      "shorter. {} the place out of stress figures by analysis.exclude",
      figures.load_case, s.position.x(), s.position.y(), s.position.z(),
      fmt::format(fmt::runtime(s.clamped ? "the held '{}' ends at '{}'"
                                         : "'{}' and '{}' meet in a groove"),
                  s.surfaces[0], s.surfaces[1]),
      degrees(s.angle), quantity_text(s.von_mises, units.pressure, 4),
      100.0 * (std::pow(2.0, s.order) - 1.0), kShorterEdges,
      s.clamped ? "Leave"
                : "Make the groove shallower (a response of kind groove shows "
                  "how deep it is), or leave");
}

std::optional<double> safety_with_error(const StressFigures& figures) {
  if (!figures.safety || !std::isfinite(figures.peak_error)) {
    return std::nullopt;
  }
  return figures.safety->yield_strength /
         (figures.safety->von_mises + figures.peak_error);
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
    if (f.is_unit_load) {
      continue;
    }
    const Vec3& at = f.position;
    text += fmt::format("  peak stress, {:<8} {}", f.load_case,
                        quantity_text(f.max_von_mises, units.pressure));
    if (std::isfinite(f.peak_error)) {
      text += "  +- " + quantity_text(f.peak_error, units.pressure, 3);
    }
    text += fmt::format(" at ({:.4g}, {:.4g}, {:.4g})", at.x(), at.y(), at.z());
    text += f.direction
                ? ", load along " + responses::direction_text(*f.direction)
                : "";
    if (f.safety) {
      text += fmt::format(", safety {:.3g}", f.safety->factor);
      text += safety_text(f, units);
    }
    text += figures.size() > 1 && k == worst ? "   <- the worst\n" : "\n";
    if (f.excluded) {
      const Vec3& out = f.excluded->position;
      text += fmt::format(
          "    in what is left out {} at ({:.4g}, {:.4g}, {:.4g})",
          quantity_text(f.excluded->max_von_mises, units.pressure, 4), out.x(),
          out.y(), out.z());
      text += f.excluded->safety
                  ? fmt::format(", safety {:.3g}\n", f.excluded->safety->factor)
                  : "\n";
    }
  }
  return text;
}

Json stress_json(const std::vector<StressFigures>& figures) {
  Json json = Json::object();
  for (const StressFigures& f : figures) {
    Json entry = {{"max_von_mises", f.max_von_mises},
                  {"position", files::place_json(f.position)},
                  {"readings",
                   {{"recovered", f.readings.recovered.von_mises},
                    {"averaged", f.readings.averaged.von_mises},
                    {"points", f.readings.points.von_mises}}},
                  {"error", f.peak_error}};
    if (f.is_unit_load) {
      entry["unit_load"] = true;
    }
    if (f.direction) {
      entry["direction"] = files::place_json(*f.direction);
    }
    if (f.safety && !f.is_unit_load) {
      entry["safety_factor"] = safety_json(*f.safety);
      if (const auto least = safety_with_error(f)) {
        entry["safety_factor"]["with_error"] = *least;
      }
    }
    if (has_no_limit(f)) {
      entry["no_limit"] = no_limit_json(*f.singular);
    }
    if (f.excluded) {
      entry["excluded"] = {
          {"max_von_mises", f.excluded->max_von_mises},
          {"position", files::place_json(f.excluded->position)}};
      if (f.excluded->safety && !f.is_unit_load) {
        entry["excluded"]["safety_factor"] = safety_json(*f.excluded->safety);
      }
    }
    if (f.uniformity) {
      entry["von_mises"] = uniformity_json(f.uniformity->von_mises);
      entry["energy_density"] = uniformity_json(f.uniformity->energy_density);
    }
    json[f.load_case] = std::move(entry);
  }
  return json;
}

}  // namespace meniscus::forward
