#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/count_text.h"
#include "core/json.h"
#include "fea/stress/averaged_stress.h"
#include "io/calculix_frd.h"
#include "io/vtk_files.h"
#include "pipeline/decks/solve_deck.h"
#include "pipeline/files/place_json.h"
#include "pipeline/forward/figures_json.h"
#include "pipeline/results/results.h"
#include "pipeline/results/run_files.h"

namespace meniscus::decks {

namespace {

using DeckJson = nlohmann::ordered_json;

const char* procedure_name(deck::DeckProcedure procedure) {
  switch (procedure) {
    case deck::DeckProcedure::Frequency:
      return "frequency";
    case deck::DeckProcedure::Buckling:
      return "buckle";
    case deck::DeckProcedure::Static:
      break;
  }
  return "static";
}

std::vector<double> values_of(const VectorX& v) {
  return {v.data(), v.data() + v.size()};
}

/// As CalculiX does: means of what elements extrapolate to their nodes.
std::vector<double> averaged_values(const forward::EvaluationFields& fields,
                                    std::size_t load_case) {
  const stress::StressField field = stress::nodal_stress(
      fields.mesh, stress::average_extrapolations(
                       fields.mesh, fields.stresses[load_case].points,
                       stress::MeanWeight::Equal));
  std::vector<double> values;
  for (const element::Stress& s : field.nodal) {
    values.insert(values.end(), s.begin(), s.end());
  }
  return values;
}

void add_mode_results(const std::vector<double>& values,
                      const std::vector<VectorX>& shapes,
                      io::FrdAnalysis analysis, int step,
                      std::vector<io::FrdResult>& results) {
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    results.push_back({analysis,
                       step,
                       static_cast<int>(k) + 1,
                       values[k],
                       {{io::FrdKind::Displacement, values_of(shapes[k])}}});
  }
}

std::vector<io::FrdResult> frd_results(const DeckResult& result) {
  std::vector<io::FrdResult> results;
  for (std::size_t s = 0; s < result.steps.size(); ++s) {
    const DeckStepFigures& step = result.steps[s];
    const int number = static_cast<int>(s) + 1;
    if (step.load_case) {
      const std::size_t c = *step.load_case;
      const equations::ElasticSolution& solution = result.fields.solution;
      io::FrdResult fields{.step = number, .value = 1.0 * number, .fields = {}};
      fields.fields = {
          {io::FrdKind::Displacement, values_of(solution.displacements[c])},
          {io::FrdKind::Stress, averaged_values(result.fields, c)},
          {io::FrdKind::Force, values_of(solution.reactions[c])}};
      results.push_back(std::move(fields));
    }
    if (step.frequencies) {
      add_mode_results(step.frequencies->frequencies, step.frequencies->shapes,
                       io::FrdAnalysis::Frequency, number, results);
    }
    if (step.buckling) {
      add_mode_results(step.buckling->factors, step.buckling->shapes,
                       io::FrdAnalysis::Buckling, number, results);
    }
  }
  return results;
}

std::vector<std::string> material_names(const DeckResult& result) {
  std::vector<std::string> names;
  for (const element::Material& m : result.fields.inputs.materials) {
    names.push_back(m.name);
  }
  return names;
}

DeckJson step_json(const DeckStepFigures& step) {
  DeckJson json = {{"name", step.name},
                   {"procedure", procedure_name(step.procedure)}};
  if (step.load_case) {
    json["largest_displacement"] = {
        {"value", step.largest_displacement},
        {"node", step.largest_node},
        {"position", files::place_json(step.largest_position)}};
    json["load"] = files::place_json(step.load);
    json["reaction"] = files::place_json(step.reaction);
  }
  if (step.frequencies) {
    json["natural_frequencies"] = {
        {"rigid_motions", step.frequencies->rigid_motions},
        {"values", step.frequencies->frequencies},
        {"residuals", step.frequencies->residuals}};
  }
  if (step.buckling) {
    json["buckling"] = {{"factors", step.buckling->factors},
                        {"residuals", step.buckling->residuals}};
    if (step.buckling->factors.empty() && !step.buckling->failure) {
      json["buckling"]["none_below"] = step.buckling->none_below;
    }
  }
  return json;
}

/// Modes that did not converge.
std::vector<std::string> deck_warnings(const DeckResult& result) {
  std::vector<std::string> warnings;
  for (const DeckStepFigures& step : result.steps) {
    const auto add = [&](const auto& modes) {
      if (modes && modes->failure) {
        warnings.push_back(
            fmt::format("step '{}': {}", step.name, modes->failure->message));
      }
    };
    add(step.frequencies);
    add(step.buckling);
  }
  return warnings;
}

DeckJson deck_json(const DeckResult& result,
                   const std::optional<UnitSystem>& units,
                   const std::string& program_version) {
  const forward::EvaluationFields& fields = result.fields;
  DeckJson json;
  json["schema_version"] = results::kResultSchemaVersion;
  json["deck"] = result.title;
  json["program_version"] = program_version;
  json["units"] = units ? forward::units_json(*units) : DeckJson();
  json["tet"] = {{"nodes", fields.mesh.nodes.size()},
                 {"elements", fields.mesh.element_count()}};
  if (!fields.inputs.load_cases.empty()) {
    json["fea"] = forward::fea_json(fields.solution.report);
    json["fea"]["element_order"] = fields.mesh.order;
  }
  json["volume"] = result.volume;
  json["mass"] = result.mass ? DeckJson(*result.mass) : DeckJson();
  json["materials"] = material_names(result);
  json["steps"] = DeckJson::array();
  for (const DeckStepFigures& step : result.steps) {
    json["steps"].push_back(step_json(step));
  }
  json["stress"] = forward::stress_json(result.stress);
  json["not_needed"] = result.not_needed;
  json["seconds"] = {{"total", result.seconds}};
  json["warnings"] = deck_warnings(result);
  return json;
}

/// A mesh whose steps solve for frequencies alone has no worst load case.
void write_deck_vtu(const DeckResult& result, const case_data::Case& input,
                    const std::filesystem::path& folder) {
  if (!result.fields.stresses.empty()) {
    results::write_part(folder / "part.vtu", input, result.fields);
    results::write_part_surface(folder / "part_surface.vtp", input,
                                result.fields);
    return;
  }
  io::MeshFields fields;
  fields.notes = {{"title", input.title}, {"length_unit", input.units.length}};
  for (const forward::ModeShape& mode : result.fields.modes) {
    fields.points.push_back({.name = mode.name,
                             .unit = {},
                             .components = 3,
                             .values = values_of(mode.shape)});
    fields.notes.emplace_back(mode.name, mode.value);
  }
  io::write_vtu(folder / "part.vtu", result.fields.mesh, fields);
  io::write_boundary_vtp(folder / "part_surface.vtp", result.fields.mesh,
                         fields);
}

std::string unit_behind(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string point_text(const Vec3& x) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", x.x(), x.y(), x.z());
}

std::string values_text(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) {
    texts.push_back(fmt::format("{:.6g}", value));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string static_text(const DeckResult& result, const DeckStepFigures& step,
                        const UnitSystem& units) {
  const forward::StressFigures& stress = result.stress[*step.load_case];
  return fmt::format(
      "    largest displacement {} at node {} {}\n"
      "    peak von Mises {} at {} ({} averaged, {} at integration points)\n"
      "    loads {}, reactions {}\n",
      quantity_text(step.largest_displacement, units.length), step.largest_node,
      point_text(step.largest_position),
      quantity_text(stress.max_von_mises, units.pressure),
      point_text(stress.position),
      fmt::format("{:.5g}", stress.readings.averaged.von_mises),
      fmt::format("{:.5g}", stress.readings.points.von_mises),
      unit_behind(point_text(step.load), units.force),
      unit_behind(point_text(step.reaction), units.force));
}

std::string modes_text(const DeckStepFigures& step, const std::string& unit) {
  std::string text;
  if (step.frequencies) {
    const modes::NaturalModes& modes = *step.frequencies;
    text += fmt::format(
        "    natural frequencies {}{}{}\n",
        unit_behind(values_text(modes.frequencies), unit),
        modes.rigid_motions > 0
            ? fmt::format(", {} left out", count_text(static_cast<std::size_t>(
                                                          modes.rigid_motions),
                                                      "rigid motion"))
            : "",
        modes.failure ? " (not converged)" : "");
  }
  if (step.buckling) {
    const modes::BucklingModes& modes = *step.buckling;
    text += modes.factors.empty() && !modes.failure
                ? fmt::format("    no buckling factor below {:.4g}\n",
                              modes.none_below)
                : fmt::format("    buckling at {} x the loads{}\n",
                              values_text(modes.factors),
                              modes.failure ? " (not converged)" : "");
  }
  return text;
}

}  // namespace

void write_deck_result(const DeckResult& result,
                       const std::optional<UnitSystem>& units,
                       const std::string& program_version,
                       const std::filesystem::path& folder) {
  results::claim_files(
      folder, {"part.vtu", "part_surface.vtp", "part.frd", "result.json"});
  const case_data::Case input = deck_case(result, units);
  write_deck_vtu(result, input, folder);
  io::FrdOptions frd;
  frd.notes.program = "Meniscus " + program_version;
  frd.notes.title = result.title;
  frd.notes.unit = input.units.length;
  frd.notes.unit_system = input.units.name;
  frd.node_numbers = result.node_numbers;
  frd.element_numbers = result.element_numbers;
  frd.materials = material_names(result);
  io::write_frd(folder / "part.frd", result.fields.mesh, frd_results(result),
                frd);
  write_file(folder / "result.json",
             json_text(deck_json(result, units, program_version), 2) + "\n");
}

std::string deck_text(const DeckResult& result,
                      const std::optional<UnitSystem>& units) {
  const UnitSystem shown = units.value_or(UnitSystem{});
  const TetMesh& mesh = result.fields.mesh;
  std::string text = fmt::format(
      "{}: {} nodes, {} {}, volume {}{}{}\n", result.title, mesh.nodes.size(),
      mesh.element_count(), mesh.order == 1 ? "C3D4" : "C3D10",
      quantity_text(result.volume,
                    units ? shown.unit_of(Dimension::Volume) : ""),
      result.mass
          ? ", mass " + (units ? shown.shown(Dimension::Mass).text(*result.mass)
                               : fmt::format("{:.6g}", *result.mass))
          : "",
      units ? "" : " (all in the deck's own units)");
  for (const DeckStepFigures& step : result.steps) {
    text += fmt::format("  step '{}', {}\n", step.name,
                        procedure_name(step.procedure));
    if (step.load_case) {
      text += static_text(result, step, shown);
    }
    text += modes_text(step, units ? "Hz" : "per time");
  }
  if (!result.not_needed.empty()) {
    text +=
        fmt::format("  not needed: {}\n", fmt::join(result.not_needed, ", "));
  }
  for (const std::string& warning : deck_warnings(result)) {
    text += fmt::format("  warning: {}\n", warning);
  }
  return text;
}

}  // namespace meniscus::decks
