#include "pipeline/results/part_comparison.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/geometry/mesh_seams.h"
#include "fea/functionals/volume_functionals.h"
#include "fea/loads/loads.h"
#include "pipeline/files/place_json.h"
#include "pipeline/forward/figures_json.h"
#include "pipeline/forward/stress_figures.h"
#include "pipeline/results/results.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"

namespace meniscus::results {

namespace {

using Json = nlohmann::ordered_json;

// A resultant below this part of the forces' sum is rounding.
constexpr double kNoResultant = 1e-9;

/// Of the nodes that count.
double largest_principal(const TetMesh& mesh, const stress::Excluded& excluded,
                         const stress::RecoveredStress& recovered) {
  const stress::StressField field = stress::nodal_stress(mesh, recovered);
  double largest = -std::numeric_limits<double>::infinity();
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (const int n : mesh.element(e)) {
      if (!excluded.counts(e, n)) {
        continue;
      }
      const element::Stress& stress = field.nodal[static_cast<std::size_t>(n)];
      largest = std::max(largest, element::principal_stresses(stress)[0]);
    }
  }
  return largest;
}

PartLoadFigures load_figures(const forward::EvaluationFields& fields,
                             std::size_t k,
                             const forward::StressFigures& stress) {
  const loads::LoadCase& load_case = fields.inputs.load_cases[k];
  PartLoadFigures figures{
      .load_case = load_case.name,
      .stiffness = std::nullopt,
      .max_von_mises = stress.max_von_mises,
      .highest_reading = stress.readings.largest().von_mises,
      .peak_position = stress.position,
      .max_principal = largest_principal(fields.mesh, fields.exclusion.what,
                                         fields.stresses[k].recovered),
      .coefficient_of_variation =
          stress.uniformity->von_mises.coefficient_of_variation,
      .gini = stress.uniformity->von_mises.gini};
  const VectorX forces =
      loads::nodal_forces(fields.mesh, load_case, fields.inputs.materials);
  figures.work = forces.dot(fields.solution.displacements[k]);
  Vec3 resultant = Vec3::Zero();
  double sum = 0.0;
  for (Eigen::Index n = 0; n < forces.size(); n += 3) {
    resultant += forces.segment<3>(n);
    sum += forces.segment<3>(n).norm();
  }
  if (!load_case.temperature && figures.work > 0.0 &&
      resultant.norm() > kNoResultant * sum) {
    figures.stiffness = resultant.squaredNorm() / figures.work;
  }
  return figures;
}

/// The figure of `part` under the load case of that name.
const PartLoadFigures* find(const PartFigures& part, const std::string& name) {
  const auto at =
      std::find_if(part.load_cases.begin(), part.load_cases.end(),
                   [&](const auto& f) { return f.load_case == name; });
  return at == part.load_cases.end() ? nullptr : &*at;
}

/// Adds rows to the table of comparison.
class Table {
 public:
  explicit Table(const std::vector<PartFigures>& parts) : parts_(parts) {
    std::vector<std::string> head = {"", parts[0].name};
    for (std::size_t k = 1; k < parts.size(); ++k) {
      head.push_back(parts[k].name);
      head.emplace_back("ratio");
    }
    rows.push_back(std::move(head));
  }

  void add(const std::string& what, const std::string& unit,
           const std::function<std::optional<double>(const PartFigures&)>& of) {
    std::vector<std::string> row = {
        unit.empty() ? what : fmt::format("{} [{}]", what, unit)};
    const std::optional<double> first = of(parts_[0]);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const std::optional<double> value = of(parts_[k]);
      row.push_back(value ? fmt::format("{:.6g}", *value) : "");
      if (k > 0) {
        const bool both = value && first && *first != 0.0;
        row.push_back(both ? fmt::format("{:.4g}", *value / *first) : "");
      }
    }
    rows.push_back(std::move(row));
  }

  void add_texts(const std::string& what,
                 const std::function<std::string(const PartFigures&)>& of) {
    std::vector<std::string> row = {what};
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      row.push_back(of(parts_[k]));
      if (k > 0) {
        row.emplace_back();
      }
    }
    rows.push_back(std::move(row));
  }

  std::vector<std::vector<std::string>> rows;

 private:
  const std::vector<PartFigures>& parts_;
};

void add_load_case(Table& table, const std::string& name,
                   const UnitSystem& units) {
  const std::string stiffness_unit = units.force + "/" + units.length;
  const auto figure =
      [&](const std::function<std::optional<double>(
              const PartFigures&, const PartLoadFigures&)>& of) {
        return [&name, of](const PartFigures& part) -> std::optional<double> {
          const PartLoadFigures* figures = find(part, name);
          return figures == nullptr ? std::nullopt : of(part, *figures);
        };
      };
  table.add(
      name + ": stiffness", stiffness_unit,
      figure([](const auto& /*part*/, const auto& f) { return f.stiffness; }));
  table.add(name + ": stiffness per mass", stiffness_unit + "/" + units.mass,
            figure([](const auto& part, const auto& f) {
              return f.stiffness && part.mass > 0.0
                         ? std::optional(*f.stiffness / part.mass)
                         : std::nullopt;
            }));
  table.add(name + ": peak von Mises", units.pressure,
            figure([](const auto& /*part*/, const auto& f) {
              return std::optional(f.max_von_mises);
            }));
  table.add(name + ": its highest reading", units.pressure,
            figure([](const auto& /*part*/, const auto& f) {
              return std::optional(f.highest_reading);
            }));
  table.add_texts(fmt::format("{}: peak at [{}]", name, units.length),
                  [&name](const PartFigures& part) {
                    const PartLoadFigures* f = find(part, name);
                    return f == nullptr
                               ? std::string()
                               : fmt::format("({:.4g}, {:.4g}, {:.4g})",
                                             f->peak_position.x(),
                                             f->peak_position.y(),
                                             f->peak_position.z());
                  });
  table.add(name + ": peak principal", units.pressure,
            figure([](const auto& /*part*/, const auto& f) {
              return std::optional(f.max_principal);
            }));
  table.add(name + ": coefficient of variation", "",
            figure([](const auto& /*part*/, const auto& f) {
              return std::optional(f.coefficient_of_variation);
            }));
  table.add(name + ": Gini", "",
            figure([](const auto& /*part*/, const auto& f) {
              return std::optional(f.gini);
            }));
}

std::vector<std::string> load_case_names(
    const std::vector<PartFigures>& parts) {
  std::vector<std::string> names;
  for (const PartFigures& part : parts) {
    for (const PartLoadFigures& f : part.load_cases) {
      if (std::find(names.begin(), names.end(), f.load_case) == names.end()) {
        names.push_back(f.load_case);
      }
    }
  }
  return names;
}

Json part_json(const PartFigures& part) {
  Json json = {{"name", part.name},
               {"parts", part.parts},
               {"weld_length", part.weld_length},
               {"volume", part.volume},
               {"mass", part.mass},
               {"elements", part.elements},
               {"load_cases", Json::object()}};
  if (!part.surface.empty()) {
    json["surface"] = part.surface;
  }
  if (!part.zones.empty()) {
    const auto share_json = [](const forward::ExclusionShare& share) {
      return Json{{"elements", share.elements},
                  {"volume_share", share.volume_share}};
    };
    json["exclusion"] = share_json(part.left_out);
    json["exclusion"]["zones"] = Json::array();
    for (const forward::ExclusionShare& zone : part.zones) {
      Json entry = {{"where", zone.where}};
      entry.update(share_json(zone));
      json["exclusion"]["zones"].push_back(std::move(entry));
    }
  }
  for (const PartLoadFigures& f : part.load_cases) {
    Json entry = {{"stiffness", nullptr},
                  {"stiffness_per_mass", nullptr},
                  {"work", f.work},
                  {"max_von_mises", f.max_von_mises},
                  {"highest_reading", f.highest_reading},
                  {"position", files::place_json(f.peak_position)},
                  {"max_principal", f.max_principal},
                  {"coefficient_of_variation", f.coefficient_of_variation},
                  {"gini", f.gini}};
    if (f.stiffness) {
      entry["stiffness"] = *f.stiffness;
      if (part.mass > 0.0) {
        entry["stiffness_per_mass"] = *f.stiffness / part.mass;
      }
    }
    json["load_cases"][f.load_case] = std::move(entry);
  }
  return json;
}

}  // namespace

PartFigures part_figures(const std::string& name,
                         forward::EvaluationFields& fields) {
  if (fields.shell) {
    throw InvalidInput(fmt::format(
        "'{}' is a shell, and parts are compared as solids; give it [walls] in "
        "place of [shells]",
        name));
  }
  fields.stresses =
      forward::part_stresses(fields.mesh, fields.inputs, fields.solution);
  PartFigures part{
      .name = name,
      .parts = piece_count(fields.mesh),
      .weld_length = seam_length(fields.mesh),
      .volume = functionals::volume_functional(fields.mesh,
                                               element::Derivatives::None)
                    .value,
      .mass = functionals::mass_functional(fields.mesh, fields.inputs.materials,
                                           element::Derivatives::None)
                  .value,
      .elements = fields.mesh.element_count(),
      .load_cases = {},
      .left_out = fields.exclusion.all,
      .zones = fields.exclusion.zones};
  const std::vector<forward::StressFigures> stresses =
      forward::stress_figures(fields);
  for (std::size_t k = 0; k < stresses.size(); ++k) {
    part.load_cases.push_back(load_figures(fields, k, stresses[k]));
  }
  return part;
}

RunPart load_run_part(const std::filesystem::path& folder, Monitor* monitor) {
  const store::StudyStore store = store::StudyStore::read(folder.string());
  const std::vector<store::EvaluationRecord> records = store.all();
  RunPart part;
  part.input = store::restore_case(store.meta());
  part.design = store::answer_of_run(part.input, records, folder);
  part.input =
      store::frozen_as_answered(std::move(part.input), records, part.design);
  const forward::ForwardModel model(part.input, {.monitor = monitor});
  const forward::Evaluation found =
      model.failure() ? model.frozen()
                      : model.evaluate(part.design, &part.fields);
  if (found.failure) {
    throw MeshError(fmt::format("{}: the run's part cannot be made again: {}",
                                folder.string(), found.failure->message));
  }
  part.figures = part_figures(folder.string(), part.fields);
  return part;
}

std::vector<std::vector<std::string>> comparison_table(
    const std::vector<PartFigures>& parts, const UnitSystem& units) {
  Table table(parts);
  table.add("parts", "", [](const PartFigures& part) {
    return std::optional<double>(part.parts);
  });
  table.add("weld length", units.length, [](const PartFigures& part) {
    return std::optional(part.weld_length);
  });
  table.add("mass", units.mass,
            [](const PartFigures& part) { return std::optional(part.mass); });
  table.add("volume", units.unit_of(Dimension::Volume),
            [](const PartFigures& part) { return std::optional(part.volume); });
  const auto has_zones = [](const PartFigures& part) {
    return !part.zones.empty();
  };
  if (std::any_of(parts.begin(), parts.end(), has_zones)) {
    table.add("left out of stresses", "% of the volume",
              [](const PartFigures& part) {
                return std::optional(100.0 * part.left_out.volume_share);
              });
  }
  for (const std::string& name : load_case_names(parts)) {
    add_load_case(table, name, units);
  }
  return std::move(table.rows);
}

Json comparison_json(const std::vector<PartFigures>& parts,
                     const UnitSystem& units,
                     const std::string& program_version) {
  Json json = {{"schema_version", kResultSchemaVersion},
               {"program_version", program_version},
               {"units", forward::units_json(units)},
               {"parts", Json::array()}};
  for (const PartFigures& part : parts) {
    json["parts"].push_back(part_json(part));
  }
  return json;
}

}  // namespace meniscus::results
