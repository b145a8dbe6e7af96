#include "pipeline/results/results.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/heed_stop.h"
#include "core/json.h"
#include "io/stl.h"
#include "io/vtk_files.h"
#include "pipeline/accuracy/mesh_errors.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/case_data/composed_responses.h"
#include "pipeline/files/named_values.h"
#include "pipeline/files/place_json.h"
#include "pipeline/forward/figures_json.h"
#include "pipeline/forward/norm_peaks.h"
#include "pipeline/forward/walls.h"
#include "pipeline/results/export_part.h"
#include "pipeline/results/multiplier_figures.h"
#include "pipeline/results/run_files.h"
#include "pipeline/shells/shell_body.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/store/study_table.h"
#include "pipeline/store/topology_events.h"
#include "pipeline/whole/whole_part.h"

namespace meniscus::results {

namespace {

using Json = nlohmann::ordered_json;

Json seconds_json(const forward::StageSeconds& seconds) {
  return {{"evolve", seconds.film},
          {"mesh", seconds.mesh},
          {"fea", seconds.fea},
          {"gradient", seconds.gradient}};
}

/// A field of `components` values per node from what numbers them by node.
io::Field node_field(const std::string& name, const std::string& unit,
                     int components, const double* values, std::size_t count) {
  return {.name = name,
          .unit = unit,
          .components = components,
          .values = {values, values + count}};
}

io::Field element_field(const char* name, const std::string& unit) {
  return {.name = name, .unit = unit};
}

/// What elements have of a load case: stresses at integration points, one after
/// the other, and their errors.
std::vector<io::Field> element_fields(const case_data::Case& input,
                                      const forward::EvaluationFields& fields,
                                      std::size_t load_case) {
  const forward::PartStress& first = fields.stresses[load_case];
  io::Field stress = element_field("point_stress", input.units.pressure);
  stress.components = 6 * first.points.points_per_element;
  for (const element::Stress& s : first.points.stress) {
    stress.values.insert(stress.values.end(), s.begin(), s.end());
  }
  io::Field error = element_field("energy_error", "");
  error.values = first.error.element;
  io::Field excluded = element_field("excluded", "");
  const std::vector<char>& out = fields.exclusion.what.element;
  excluded.values.assign(out.begin(), out.end());
  excluded.values.resize(first.error.element.size(), 0.0);
  return {std::move(stress), std::move(error), std::move(excluded)};
}

/// Displacement and stresses of a load case at the nodes; `ending` of names.
void add_node_fields(const case_data::Case& input,
                     const forward::EvaluationFields& fields,
                     std::size_t load_case, const std::string& ending,
                     io::MeshFields& out) {
  const VectorX& u = fields.solution.displacements[load_case];
  const stress::StressField nodal =
      stress::nodal_stress(fields.mesh, fields.stresses[load_case].recovered);
  out.points.push_back(node_field("displacement" + ending, input.units.length,
                                  3, u.data(),
                                  static_cast<std::size_t>(u.size())));
  io::Field stress{
      .name = "stress" + ending, .unit = input.units.pressure, .components = 6};
  for (const auto& s : nodal.nodal) {
    // xx yy zz xy yz zx: VTK's order of a symmetric tensor too.
    stress.values.insert(stress.values.end(), s.begin(), s.end());
  }
  out.points.push_back(std::move(stress));
  out.points.push_back(node_field("von_mises" + ending, input.units.pressure, 1,
                                  nodal.von_mises.data(),
                                  nodal.von_mises.size()));
}

io::Field shell_field(const case_data::Case& input, const std::string& name,
                      std::vector<double> values) {
  return {
      .name = name, .unit = input.units.pressure, .values = std::move(values)};
}

/// Numbers of the shell's nodes behind those of the solids beside it.
std::vector<double> behind_solids(const shells::ShellPart& part,
                                  std::vector<double> solid,
                                  const std::vector<double>& shell) {
  if (part.solid) {
    solid.resize(shell.size() / part.mesh.nodes.size() *
                 part.solid->mesh.nodes.size());
  }
  solid.insert(solid.end(), shell.begin(), shell.end());
  return solid;
}

/// Displacement, rotation and stresses of a load case; von_mises is the largest
/// of both faces and the middle.
void add_shell_fields(const case_data::Case& input,
                      const forward::EvaluationFields& fields,
                      std::size_t load_case, const std::string& ending,
                      io::MeshFields& out) {
  const shells::ShellPart& part = *fields.shell;
  const VectorX& u = fields.solution.displacements[load_case];
  out.points.push_back(node_field("displacement" + ending, input.units.length,
                                  3, u.data(),
                                  static_cast<std::size_t>(u.size())));
  const VectorX turned =
      shell::rotations_of(part.cases[load_case].displacement);
  const std::vector<double> turns =
      behind_solids(part, {}, {turned.begin(), turned.end()});
  out.points.push_back(
      node_field("rotation" + ending, "rad", 3, turns.data(), turns.size()));
  std::vector<double> of_solid;
  if (part.solid) {
    of_solid = stress::nodal_stress(part.solid->mesh,
                                    part.cases[load_case].solid_stress)
                   .von_mises;
  }
  using W = shell::WallStress;
  for (const auto& [name, height] :
       {std::pair("back", &W::negative), std::pair("middle", &W::middle),
        std::pair("front", &W::positive)}) {
    out.points.push_back(shell_field(
        input, std::string(name) + "_von_mises" + ending,
        behind_solids(part, of_solid,
                      shells::nodal_von_mises(part, load_case, {height}))));
  }
  out.points.push_back(shell_field(
      input, "von_mises" + ending,
      behind_solids(
          part, of_solid,
          shells::nodal_von_mises(part, load_case,
                                  {&W::negative, &W::middle, &W::positive}))));
}

/// Mean over the facets at each node, linear along edges.
io::Field thickness_field(const case_data::Case& input,
                          const shell::ShellMesh& mesh) {
  io::Field field{.name = "thickness", .unit = input.units.length};
  field.values.assign(mesh.nodes.size(), 0.0);
  std::vector<double> count(mesh.nodes.size(), 0.0);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const std::array<double, 6> at = shell::facet_thicknesses(mesh, f);
    for (std::size_t i = 0; i < at.size(); ++i) {
      field.values[mesh.facets[f][i]] += at[i];
      count[mesh.facets[f][i]] += 1.0;
    }
  }
  for (std::size_t n = 0; n < count.size(); ++n) {
    field.values[n] /= count[n];
  }
  return field;
}

/// Adds those of a load case, their names with an ending.
using AddFields = std::function<void(
    std::size_t load_case, const std::string& ending, io::MeshFields& out)>;

/// Those of one load case by plain names, the worst where `load_case` is none;
/// all by their own where there are several.
io::MeshFields case_fields(const case_data::Case& input,
                           const forward::EvaluationFields& fields,
                           const std::string& load_case, const AddFields& add) {
  std::size_t worst = forward::worst_load_case(fields);
  const std::vector<loads::LoadCase>& cases = fields.inputs.load_cases;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    worst = cases[k].name == load_case ? k : worst;
  }
  io::MeshFields out;
  add(worst, "", out);
  for (std::size_t k = 0; cases.size() > 1 && k < cases.size(); ++k) {
    add(k, "_" + cases[k].name, out);
  }
  if (!fields.shell) {
    out.cells = element_fields(input, fields, worst);
  }
  out.notes = {{"title", input.title},
               {"length_unit", input.units.length},
               {"load_case", cases[worst].name}};
  return out;
}

io::MeshFields part_fields(const case_data::Case& input,
                           const forward::EvaluationFields& fields,
                           const std::string& load_case = "") {
  io::MeshFields out = case_fields(
      input, fields, load_case,
      [&](std::size_t k, const std::string& ending, io::MeshFields& to) {
        (fields.shell ? add_shell_fields : add_node_fields)(input, fields, k,
                                                            ending, to);
      });
  if (fields.shell) {
    io::Field thickness = thickness_field(input, fields.shell->mesh);
    thickness.values = behind_solids(*fields.shell, {}, thickness.values);
    out.points.push_back(std::move(thickness));
  }
  for (const forward::ModeShape& mode : fields.modes) {
    out.points.push_back(
        node_field(mode.name, "", 3, mode.shape.data(),
                   static_cast<std::size_t>(mode.shape.size())));
    out.notes.emplace_back(mode.name, mode.value);
  }
  return out;
}

/// Of a shell's body, each face with its own stress.
io::MeshFields body_fields(const case_data::Case& input,
                           const forward::EvaluationFields& fields,
                           const shells::ShellBody& body,
                           const std::string& load_case) {
  const shells::ShellPart& part = *fields.shell;
  io::MeshFields out = case_fields(
      input, fields, load_case,
      [&](std::size_t k, const std::string& ending, io::MeshFields& to) {
        const VectorX u =
            shells::body_displacements(body, part.cases[k].displacement);
        to.points.push_back(node_field("displacement" + ending,
                                       input.units.length, 3, u.data(),
                                       static_cast<std::size_t>(u.size())));
        to.points.push_back(shell_field(input, "von_mises" + ending,
                                        shells::body_von_mises(body, part, k)));
      });
  for (const forward::ModeShape& mode : fields.modes) {
    io::Field field = node_field(mode.name, "", 3, nullptr, 0);
    for (const shells::ShellBody::Point& at : body.points) {
      const Vec3 u = mode.shape.segment<3>(Eigen::Index{3} * at.node);
      field.values.insert(field.values.end(), u.begin(), u.end());
    }
    out.points.push_back(std::move(field));
    out.notes.emplace_back(mode.name, mode.value);
  }
  return out;
}

/// The boundary of the part, of shells beside solids their facets; or of the
/// body that a shell stands for.
void write_surface(const std::filesystem::path& file,
                   const case_data::Case& input,
                   const forward::EvaluationFields& fields,
                   const std::string& load_case = "") {
  if (fields.shell && !fields.shell->solid) {
    const shells::ShellBody body = shells::shell_body(*fields.shell);
    io::write_boundary_vtp(file, body.mesh,
                           body_fields(input, fields, body, load_case));
  } else {
    io::write_boundary_vtp(file, fields.mesh,
                           part_fields(input, fields, load_case));
  }
}

Json value_map(const std::vector<std::string>& names, const VectorX& values) {
  Json map = Json::object();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    map[names[static_cast<std::size_t>(k)]] = values[k];
  }
  return map;
}

Json parameters_json(const case_data::Case& input, const VectorX& design) {
  Json json = files::named_json(case_data::design_names(input), design);
  for (const auto& [name, value] : case_data::parameter_values(input, design)) {
    json[name] = value;
  }
  return json;
}

Json symmetry_json(const case_data::Case& input) {
  Json json = {{"parts", case_data::symmetric_parts(input)},
               {"planes", Json::array()}};
  for (const case_data::SymmetryPlane& plane : input.symmetry) {
    json["planes"].push_back({{"at", files::place_json(plane.at)},
                              {"normal", files::place_json(plane.normal)}});
  }
  return json;
}

Json coarse_json(const case_data::Case& input,
                 const study::CoarseFigures& coarse) {
  const bool answered = coarse.design.size() > 0;
  return {{"edge_factor", coarse.edge_factor},
          {"message", coarse.message},
          {"parameters", answered
                             ? files::named_json(case_data::design_names(input),
                                                 coarse.design)
                             : Json()},
          {"evaluations", coarse.evaluations},
          {"gradient_evaluations", coarse.gradients}};
}

Json refrozen_json(const case_data::Case& input,
                   const std::vector<store::Refreeze>& refrozen) {
  Json json = Json::array();
  for (const store::Refreeze& r : refrozen) {
    json.push_back(
        {{"evaluation", r.evaluation},
         {"reason", r.reason},
         {"parameters",
          files::named_json(case_data::design_names(input), r.design)},
         {"responses",
          value_map(case_data::response_names(input), r.responses)},
         {"shift", value_map(case_data::response_names(input), r.shift)}});
  }
  return json;
}

Json topology_json(const case_data::Case& input,
                   const std::vector<store::TopologyEvent>& events) {
  Json json = Json::array();
  for (const store::TopologyEvent& event : events) {
    json.push_back(
        {{"kind", name_of(event.kind)},
         {"designs", event.designs},
         {"evaluation", event.evaluation},
         {"parameters",
          files::named_json(case_data::design_names(input), event.design)},
         {"message", event.message}});
  }
  return json;
}

/// Which response each envelope has its value from.
void add_envelopes(const case_data::Case& input, const VectorX& responses,
                   Json& json) {
  const std::vector<std::string> names = case_data::response_names(input);
  for (const case_data::ResponseEntry& response : input.responses) {
    if (response.kind == case_data::ResponseKind::Envelope &&
        responses.size() > 0) {
      const int worst = case_data::extreme_part(response, responses);
      json["envelopes"][response.name] = {
          {response.least ? "least" : "most",
           names[static_cast<std::size_t>(worst)]},
          {"value", responses[worst]}};
    }
  }
}

/// Responses of stress beside the peaks, where there are such responses.
void add_norm_peaks(const case_data::Case& input, const VectorX& responses,
                    const std::vector<forward::StressFigures>& stress,
                    Json& json) {
  for (const forward::NormPeak& peak :
       forward::norm_peaks(input, responses, stress)) {
    const std::string& name =
        input.responses[static_cast<std::size_t>(peak.response)].name;
    json["norm_peaks"][name] = {{"norm", peak.value},
                                {"of", peak.is_ratio ? "bound" : "mean"},
                                {"load_case", peak.load_case},
                                {"peak", peak.peak},
                                {"position", files::place_json(peak.position)}};
    if (std::isfinite(peak.bound)) {
      json["norm_peaks"][name]["bound"] = peak.bound;
      json["norm_peaks"][name]["peak_within_bound"] = peak.peak <= peak.bound;
    }
  }
}

}  // namespace

nlohmann::ordered_json result_json(const case_data::Case& input,
                                   const study::RunResult& result,
                                   const std::string& program_version) {
  Json json;
  json["schema_version"] = kResultSchemaVersion;
  json["case"] = input.title;
  json["case_hash"] = input.hash;
  json["program_version"] = program_version;
  json["units"] = forward::units_json(input.units);
  if (!input.symmetry.empty()) {
    json["symmetry"] = symmetry_json(input);
  }
  json["status"] = study::name_of(result.status);
  json["message"] = result.message;
  const forward::Evaluation* best = result.best ? &*result.best : nullptr;
  json["parameters"] = parameters_json(
      input, best != nullptr ? best->design : case_data::initial_design(input));
  const bool has_objective =
      input.study.kind == case_data::StudyKind::Match || input.study.objective;
  json["objective"] = has_objective ? Json(result.objective) : Json();
  json["constraints"] = Json::object();
  for (const study::Constraint& c : result.constraints) {
    json["constraints"][c.name] = {
        {"value", c.value}, {"bound", c.bound}, {"satisfied", c.satisfied}};
  }
  if (result.multipliers) {
    json["multipliers"] = multipliers_json(input, *result.multipliers);
  }
  if (result.sweep) {
    json["sweep"] = study::sweep_json(input, *result.sweep);
  }
  if (result.tolerance) {
    json["tolerance"] = study::tolerance_json(input, *result.tolerance);
  }
  if (result.front) {
    json["front"] = study::front_json(input, *result.front);
  }
  const std::vector<std::string> names = case_data::response_names(input);
  json["responses"] =
      value_map(names, best != nullptr ? best->responses : VectorX());
  json["response_errors"] = value_map(names, result.response_errors);
  if (result.meshes[0].size() > 0) {
    json["meshes"] = Json::array();
    for (std::size_t m = 0; m < accuracy::kEdgeFactors.size(); ++m) {
      if (m == accuracy::kFinerMesh && result.meshes[m].size() == 0) {
        continue;
      }
      json["meshes"].push_back(
          {{"edge", accuracy::kEdgeFactors[m] * input.resolution.fea},
           {"responses", value_map(names, result.meshes[m])}});
    }
  }
  if (result.finer_film.size() > 0) {
    json["finer_film"] = value_map(names, result.finer_film);
  }
  if (result.element_errors) {
    json["element_errors"] = {
        {"energy", result.element_errors->energy},
        {"responses", value_map(names, result.element_errors->responses)}};
  }
  json["parameter_errors"] =
      files::named_json(case_data::design_names(input), result.design_errors);
  if (result.start) {
    json["start"] = {
        {"parameters", files::named_json(case_data::design_names(input),
                                         result.start->design)},
        {"responses", value_map(names, result.start->responses)}};
  }
  json["evaluations"] = result.evaluations;
  json["failed_evaluations"] = result.failed_evaluations;
  json["gradient_evaluations"] = result.gradient_evaluations;
  if (result.coarse) {
    json["coarse"] = coarse_json(input, *result.coarse);
  }
  if (!result.refrozen.empty()) {
    json["refrozen"] = refrozen_json(input, result.refrozen);
  }
  if (!result.topology.empty()) {
    json["topology"] = topology_json(input, result.topology);
  }
  if (best != nullptr) {
    json["film"] = forward::film_json(best->film);
    if (!best->film.popped.empty()) {
      json["popped"] = forward::popped_json(best->film);
    }
    if (input.shells.empty() || case_data::has_solids(input)) {
      json["tet"] = forward::tet_json(best->tet);
    } else {
      json["shell"] = {{"nodes", best->tet.nodes},
                       {"facets", best->tet.elements}};
    }
    json["fea"] = forward::fea_json(best->fea);
  }
  if (result.adaptation) {
    json["adaptation"] = forward::adaptation_json(input, *result.adaptation);
  }
  json["stress"] = forward::stress_json(result.stress);
  if (!result.stress.empty()) {
    json["worst_load_case"] =
        result.stress[forward::worst_load_case(result.stress)].load_case;
  }
  if (best != nullptr) {
    add_envelopes(input, best->responses, json);
    for (const responses::WorstLoad& worst : result.worst_loads) {
      json["worst_directions"][names[worst.response]] = {
          {"load_case", worst.load_case},
          {"direction", files::place_json(worst.direction)}};
    }
    add_norm_peaks(input, best->responses, result.stress, json);
  }
  if (result.eigen) {
    forward::add_eigen_json(*result.eigen, json);
  }
  if (!result.exclusion.zones.empty()) {
    json["exclusion"] = forward::exclusion_json(result.exclusion);
  }
  json["seconds"] = seconds_json(result.seconds);
  json["seconds"]["output"] = result.output_seconds;
  json["seconds"]["total"] = result.total_seconds;
  if (result.ledger) {
    json["ledger"] = study::ledger_json(*result.ledger);
  }
  json["warnings"] = result.warnings;
  return json;
}

void write_film(const case_data::Case& input, const SurfaceMesh& film,
                const std::filesystem::path& folder) {
  io::MeshFields fields;
  fields.notes = {{"title", input.title}, {"length_unit", input.units.length}};
  io::write_vtp(folder / "film.vtp", whole::whole_surface(input, film), fields);
}

void write_part(const std::filesystem::path& file, const case_data::Case& input,
                const forward::EvaluationFields& fields,
                const std::vector<std::pair<std::string, std::string>>& notes) {
  const std::optional<forward::EvaluationFields> whole =
      whole::whole_part(input, fields);
  const forward::EvaluationFields& shown = whole ? *whole : fields;
  io::MeshFields part = part_fields(input, shown);
  part.notes.insert(part.notes.end(), notes.begin(), notes.end());
  io::write_vtu(file, shown.mesh, part);
}

void write_part_surface(const std::filesystem::path& file,
                        const case_data::Case& input,
                        const forward::EvaluationFields& fields,
                        const std::string& load_case) {
  const std::optional<forward::EvaluationFields> whole =
      whole::whole_part(input, fields);
  const forward::EvaluationFields& shown = whole ? *whole : fields;
  write_surface(file, input, shown, load_case);
}

std::vector<std::string> mesh_names(const case_data::Case& input) {
  std::vector<std::string> names = {"film.vtp", "part.vtu", "part_surface.vtp"};
  std::vector<double> edges = input.resolution.export_edges;
  if (edges.empty()) {
    edges.push_back(input.resolution.film);
  }
  for (const double edge : edges) {
    names.push_back(stl_name(edge));
  }
  return names;
}

std::vector<std::string> write_meshes(const case_data::Case& input,
                                      const forward::EvaluationFields& fields,
                                      const std::filesystem::path& folder,
                                      const Monitor& monitor) {
  const Heeding heeding(&monitor);
  std::vector<std::string> warnings;
  claim_files(folder, mesh_names(input));
  write_film(input, fields.film, folder);
  const std::optional<forward::EvaluationFields> whole =
      whole::whole_part(input, fields);
  const forward::EvaluationFields& shown = whole ? *whole : fields;
  io::write_vtu(folder / "part.vtu", shown.mesh, part_fields(input, shown));
  write_surface(folder / "part_surface.vtp", input, shown);
  const auto write_part_stl = [&](const SurfaceMesh& mesh, double edge) {
    io::write_stl(folder / stl_name(edge), whole::whole_surface(input, mesh),
                  {.name = input.title, .unit = input.units.length});
  };
  if (input.resolution.export_edges.empty()) {
    write_part_stl(fields.shell
                       ? shells::part_surface(*fields.shell, fields.boundary)
                       : fields.boundary,
                   input.resolution.film);
  }
  for (const double edge : input.resolution.export_edges) {
    const std::string prevented = what_prevents(
        [&] { write_part_stl(settle_again(fields.inputs, edge), edge); });
    if (!prevented.empty()) {
      warnings.push_back(
          fmt::format("{}{}: {}", kNotWritten, stl_name(edge), prevented));
    }
  }
  return warnings;
}

std::vector<std::string> write_unfilled(const forward::EvaluationFields& fields,
                                        const std::filesystem::path& folder) {
  if (fields.surface.base.facets.empty() || !fields.mesh.nodes.empty()) {
    return {};
  }
  claim_files(folder, {"findings.vtp", "unfilled_surface.vtp"});
  io::write_findings_vtp(folder / "findings.vtp", fields.surface.base,
                         fields.findings);
  // Broken corners cannot be drawn; the findings leave them out.
  const auto broken = [](const Finding& finding) {
    return finding.kind == FindingKind::BadIndex ||
           finding.kind == FindingKind::NotFinite;
  };
  if (std::any_of(fields.findings.begin(), fields.findings.end(), broken)) {
    return {"findings.vtp"};
  }
  io::write_vtp(folder / "unfilled_surface.vtp", fields.surface.base);
  return {"findings.vtp", "unfilled_surface.vtp"};
}

SurfaceMesh settle_again(const case_data::EvaluatedCase& numbers, double edge) {
  const frozen::FilmModel model = frozen::FilmModel::freeze(
      numbers.film_system, {.edge = edge, .refinements = 0});
  if (model.reference().failure) {
    throw MeshError(fmt::format("no film at edge {:g}: {}", edge,
                                model.reference().failure->message));
  }
  return forward::boundary_of(numbers, model, model.reference().points);
}

std::string stl_name(double edge) { return fmt::format("part_{:g}.stl", edge); }

void write_summary(const case_data::Case& input, const study::RunResult& result,
                   const std::vector<store::EvaluationRecord>& records,
                   const std::string& program_version,
                   const std::filesystem::path& folder) {
  write_file(folder / "history.csv", store::history_csv(records));
  write_file(folder / "result.json",
             json_text(result_json(input, result, program_version), 2) + "\n");
}

}  // namespace meniscus::results
