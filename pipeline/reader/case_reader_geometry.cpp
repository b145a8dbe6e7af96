#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_curves.h"
#include "pipeline/case_data/case_sides.h"
#include "pipeline/case_data/case_symmetry.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

constexpr const char* kVoidName = "void";

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Notes keys of one kind of material that the other has or this one lacks.
void check_material(CaseContext& context, const CaseTable& table,
                    bool orthotropic) {
  const std::vector<const char*> isotropic_keys = {"youngs_modulus",
                                                   "poisson_ratio"};
  const std::vector<const char*> orthotropic_keys = {
      "youngs_moduli", "poisson_ratios", "shear_moduli"};
  const auto& needed = orthotropic ? orthotropic_keys : isotropic_keys;
  auto foreign = orthotropic ? isotropic_keys : orthotropic_keys;
  foreign.push_back(orthotropic ? "thermal_expansion" : "thermal_expansions");
  if (!orthotropic) {
    foreign.push_back("axes");
  }
  const char* kind = orthotropic ? "orthotropic" : "isotropic";
  for (const char* key : needed) {
    if (!table.has(key)) {
      context.problems.add(table.line(),
                           fmt::format("{} is {} and has no '{}'; add it",
                                       table.path(), kind, key));
    }
  }
  for (const char* key : foreign) {
    if (table.has(key)) {
      context.problems.add(
          table.line(key),
          fmt::format("{}.{} does not belong to an {} material (which has {}); "
                      "take it out",
                      table.path(), key, kind, fmt::join(needed, ", ")));
    }
  }
}

element::Orthotropic read_orthotropic(const CaseTable& table) {
  element::Orthotropic result;
  result.youngs_moduli =
      table.constant_vector("youngs_moduli").value_or(Vec3::Ones());
  result.poisson_ratios =
      table.constant_vector("poisson_ratios").value_or(Vec3::Zero());
  result.shear_moduli =
      table.constant_vector("shear_moduli").value_or(Vec3::Ones());
  result.axes = table.axes("axes").value_or(element::LocalAxes{});
  return result;
}

/// A constant above 0, or none.
std::optional<double> strength(CaseContext& context, const CaseTable& table,
                               const char* key) {
  const std::optional<double> value = table.constant(key);
  if (value && !(*value > 0.0)) {
    context.problems.add(table.line(key),
                         fmt::format("{}.{} is {:g}; it must be above 0",
                                     table.path(), key, *value));
  }
  return value;
}

void read_materials(CaseContext& context, const toml::table& root,
                    case_data::Case& result) {
  for (const CaseTable& table : named_tables(context, root, "materials")) {
    case_data::MaterialEntry material{.name = table.name(),
                                      .line = table.line()};
    if (material.name == kVoidName) {
      context.problems.add(material.line,
                           "materials.void: bodies that are void have this "
                           "name; choose another");
    }
    const bool orthotropic = table.has("youngs_moduli") ||
                             table.has("poisson_ratios") ||
                             table.has("shear_moduli");
    check_material(context, table, orthotropic);
    if (orthotropic) {
      material.orthotropic = read_orthotropic(table);
      material.thermal_expansion =
          table.constant_vector("thermal_expansions").value_or(Vec3::Zero());
    } else {
      material.youngs_modulus = table.quantity_or_zero("youngs_modulus");
      material.poisson_ratio = table.quantity_or_zero("poisson_ratio");
      material.thermal_expansion.setConstant(
          table.constant("thermal_expansion").value_or(0.0));
    }
    material.density = table.quantity_or_zero("density");
    material.yield_strength = table.quantity("yield_strength");
    material.endurance_limit = strength(context, table, "endurance_limit");
    material.tensile_strength = strength(context, table, "tensile_strength");
    material.torsion_limit = strength(context, table, "torsion_limit");
    result.materials.push_back(std::move(material));
  }
}

void find_material(CaseContext& context, const CaseTable& table,
                   const case_data::Case& result, case_data::BodyEntry& body) {
  const auto wanted = table.text("material");
  if (!wanted) {
    return;
  }
  if (*wanted == kVoidName) {
    body.material = case_data::kVoid;
    return;
  }
  std::vector<std::string> known;
  for (const case_data::MaterialEntry& material : result.materials) {
    if (material.name == *wanted) {
      body.material = static_cast<int>(known.size());
      return;
    }
    known.push_back(material.name);
  }
  context.problems.unknown(table.line("material"), "material", *wanted, known);
}

void read_bodies(CaseContext& context, const toml::table& root,
                 case_data::Case& result) {
  const std::vector<std::string> surfaces = case_data::surface_names(result);
  for (const CaseTable& table : named_tables(context, root, "bodies")) {
    case_data::BodyEntry body{.name = table.name(), .line = table.line()};
    std::set<std::string> seen;
    for (const std::string& surface :
         with_feature_faces(result, table.names("enclosed_by"))) {
      if (!contains(surfaces, surface)) {
        context.problems.unknown(table.line("enclosed_by"), "film or solid",
                                 surface, surfaces);
      } else if (!seen.insert(surface).second) {
        context.problems.add(
            table.line("enclosed_by"),
            fmt::format("{}.enclosed_by names '{}' twice; name each once",
                        table.path(), surface));
      }
      body.enclosed_by.push_back(surface);
    }
    body.enclosure_line = table.line("enclosed_by");
    body.volume = table.quantity("volume");
    body.pressure = table.quantity("pressure");
    if (table.has("volume") && table.has("pressure")) {
      context.problems.add(
          table.line("pressure"),
          table.path() + " has both a volume and a pressure; keep one");
    }
    const char* held = table.has("volume") ? "volume" : "pressure";
    if (result.films.empty() && table.has(held)) {
      context.problems.add(
          table.line(held),
          fmt::format("{}.{}: the case has no films, and plane faces follow "
                      "their curves alone; take it out",
                      table.path(), held));
    }
    find_material(context, table, result, body);
    result.bodies.push_back(std::move(body));
  }
  if (!result.bodies.empty() && case_data::solid_bodies(result).empty() &&
      !root.contains("walls") && !root.contains("shells")) {
    context.problems.add(result.bodies.front().line,
                         "all bodies are void; one must have a material, or "
                         "there is no part");
  }
}

}  // namespace

void read_geometry(CaseContext& context, const toml::table& root,
                   case_data::Case& result) {
  read_curves(context, root, result);
  const std::vector<CaseTable> solids = named_tables(context, root, "solids");
  read_features(context, solids, result);
  read_step_solids(context, solids, result);
  read_films(context, root, result);
  read_solids(context, solids, result);
  if (context.problems.empty()) {
    case_data::merge_curves(result, context.problems);
    if (root.contains("walls") || root.contains("shells")) {
      result.sharing_sides = case_data::curves_that_share_sides(result);
    }
  }
  case_data::check_joined_films(result, context.problems);
  read_materials(context, root, result);
  const std::size_t before = context.problems.size();
  read_bodies(context, root, result);
  if (context.problems.empty()) {
    case_data::add_cut_faces(result, context.problems);
  }
  case_data::check_bodies(result, context.problems);
  const bool any = !result.bodies.empty() || root.contains("walls") ||
                   root.contains("shells");  // which are read later
  context.bodies_good = any && context.problems.size() == before;
}

}  // namespace meniscus::reader
