#include "pipeline/reader/case_schema.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace meniscus::reader {

namespace {

using D = Dimension;
using K = KeyType;
using N = TableNeed;

std::vector<TableSpec> make_tables() {
  return {
      {"",
       false,
       N::Always,
       "Above the first table",
       {{"title", K::Text, D::None, true, "one line for people"},
        {"units", K::Choice, D::None, true,
         "consistent unit system of every number in the file",
         "mm-N-MPa|m-N-Pa|in-lbf-psi"},
        {"start", K::Start, std::nullopt, false,
         "where films begin: the results folder of an earlier run, beside the "
         "case or in the working folder, or values of design variables and "
         "parameters by name"}}},
      {"parameters",
       false,
       N::Optional,
       "Named numbers for expressions, `name = value`; override from outside "
       "with --set name=value",
       {}},
      {"design",
       true,
       N::Optional,
       "A design variable: what the optimizer moves",
       {{"shape", K::Shape, D::None, false,
         "makes a vector of so many elements, [8, 4] a table of 32: "
         "expressions write NAME[i, j], counted from 1"},
        {"initial", K::Elements, std::nullopt, true,
         "value at which the model freezes and the study starts; of a vector "
         "for all elements, or nested arrays of its shape"},
        {"bounds", K::Bounds, std::nullopt, true,
         "[least, largest], each as initial"}}},
      {"symmetry",
       false,
       N::Optional,
       "Planes in which what the case draws is mirrored",
       {{"planes", K::Planes, D::None, true,
         "one to three, at right angles to each other"}}},
      {"plane",
       false,
       N::Optional,
       "A plane of symmetry",
       {{"at", K::ConstantVector, D::Length, true, "a point of it"},
        {"normal", K::ConstantVector, std::nullopt, true,
         "across it, away from what is drawn; any length but 0"}}},
      curve_table(),
      film_table(),
      drop_table(),
      solid_table(),
      {"bodies",
       true,
       N::ForParts,
       "A chamber that films and solids enclose; it becomes solid material",
       {{"enclosed_by", K::Names, D::None, true,
         "films and solids that close it"},
        {"volume", K::Quantity, D::Volume, false, "enclosed volume"},
        {"pressure", K::Quantity, D::Pressure, false,
         "inside minus outside, instead of a volume"},
        {"material", K::Name, D::None, true,
         "what fills it; \"void\": nothing, and only its surfaces shape the "
         "part"}}},
      fillet_table(),
      wall_table(),
      shell_table(),
      layer_table(),
      shape_table(),
      field_table(),
      spine_table(),
      {"resolution",
       false,
       N::Always,
       "Edge lengths",
       {{"fea", K::Constant, D::Length, true,
         "of the settled film that is filled with elements"},
        {"film", K::Constant, D::Length, false,
         "of its nested refinement: fea, fea / 2, fea / 4, ... (the nearest is "
         "taken); fea / 2 when left out"},
        {"export", K::Constants, D::Length, false,
         "of the STL files, each settled again; the film's own when left "
         "out"},
        {"keep_facets", K::Flag, D::None, false,
         "films of kind facets and file keep their facets: each is cut in four "
         "until they are about as small as fea, and never remeshed; false when "
         "left out"},
        {"pop", K::Flag, D::None, false,
         "where films meet as no film keeps, more than three along a line or "
         "otherwise than in four lines, they are popped when the model is "
         "frozen; false when left out"}}},
      {"process",
       false,
       N::Optional,
       "How the part is made",
       {{"name", K::Text, D::None, false, "for messages, as \"sand casting\""},
        {"smallest_feature", K::Constant, D::Length, true,
         "the thinnest material that it can make; thinner parts are warned "
         "of, with the place"}}},
      {"materials",
       true,
       N::ForParts,
       "A linear-elastic material: isotropic (youngs_modulus, poisson_ratio) "
       "or orthotropic (youngs_moduli, poisson_ratios, shear_moduli)",
       {{"youngs_modulus", K::Quantity, D::Pressure, false, "above 0"},
        {"poisson_ratio", K::Quantity, D::None, false,
         "above -1 and below 0.5; no design variable may move it"},
        {"density", K::Quantity, D::Density, true, "mass per volume"},
        {"yield_strength", K::Quantity, D::Pressure, false,
         "stress above it is warned of"},
        {"endurance_limit", K::Constant, D::Pressure, false,
         "of fatigue: the amplitude of reversed tension that it endures"},
        {"tensile_strength", K::Constant, D::Pressure, false,
         "of fatigue by Goodman"},
        {"torsion_limit", K::Constant, D::Pressure, false,
         "of fatigue by Crossland: the amplitude of reversed torsion that it "
         "endures, at least endurance_limit / sqrt(3)"},
        {"youngs_moduli", K::ConstantVector, D::Pressure, false,
         "of orthotropic: along axes 1, 2, 3"},
        {"poisson_ratios", K::ConstantVector, D::None, false,
         "of orthotropic: 12, 13, 23; nu_12 / E_1 = nu_21 / E_2"},
        {"shear_moduli", K::ConstantVector, D::Pressure, false,
         "of orthotropic: 12, 13, 23"},
        {"axes", K::Axes, std::nullopt, false,
         "of orthotropic: axis 1, and one that spans the plane of 1 and 2; x "
         "and y when left out"},
        {"thermal_expansion", K::Constant, D::None, false,
         "strain per degree; 0 when left out"},
        {"thermal_expansions", K::ConstantVector, D::None, false,
         "of orthotropic: along axes 1, 2, 3"}}},
      bolt_table(),
      {"load_cases",
       true,
       N::ForParts,
       "Supports and loads that act together",
       {{"supports", K::Supports, D::None, true, "at least one"},
        {"loads", K::Loads, D::None, false,
         "at least one, unless a support enforces a displacement"}}},
      {"support",
       false,
       N::Optional,
       "A surface that is held, by fix or by springs",
       {{"on", K::NameOrNames, D::None, true,
         "the surface that is held, or a list of them"},
        {"fix", K::Text, D::None, false,
         "components that are held, some of \"xyz\"; \"normal\": slides; "
         "\"symmetry\": the same, and the surface must be plane"},
        {"displacement", K::Vector, D::Length, false,
         "what the components are held at; 0 when left out"},
        {"by", K::Choice, D::None, false,
         "nodes: each by itself (when left out); rigid: the surfaces move as "
         "one rigid body, whose point `at` fix holds",
         "nodes|rigid"},
        {"at", K::Vector, D::Length, false,
         "of rigid: the point; of shells: the surface's node nearest to it "
         "alone is held"},
        {"fix_rotation", K::Text, D::None, false,
         "of rigid, and of shells: rotations that are held, some of "
         "\"xyz\""},
        {"rotation", K::Vector, D::None, false,
         "of rigid, and of shells: what they are held at, in radians; 0 when "
         "left out"},
        {"stiffness", K::ConstantVector, std::nullopt, false,
         "of springs along x, y, z: force per displacement and area"},
        {"normal_stiffness", K::Constant, std::nullopt, false,
         "of springs along the normal: the same"},
        {"stiffness_of", K::Choice, D::None, false,
         "area: stiffnesses are per area (when left out); total: of the whole "
         "surface",
         "area|total"},
        {"axes", K::Axes, std::nullopt, false,
         "of components and rotations: x is along the first, y in the plane of "
         "both"}}},
      load_table(),
      analysis_table(),
      {"exclude",
       false,
       N::Optional,
       "A zone: near and distance, center and radius (a ball), or low and high "
       "(a box)",
       {{"near", K::Name, D::None, false, "a surface"},
        {"distance", K::Constant, D::Length, false,
         "from the nearest node of that surface; above 0"},
        {"center", K::ConstantVector, D::Length, false, "of a ball"},
        {"radius", K::Constant, D::Length, false, "of a ball; above 0"},
        {"low", K::ConstantVector, D::Length, false,
         "of a box along x, y, z: the least coordinates"},
        {"high", K::ConstantVector, D::Length, false,
         "of a box: the largest; above low"}}},
      response_table(),
      study_table(),
      {"constraint",
       false,
       N::Optional,
       "A bound on a response",
       {{"response", K::Name, D::None, true, "its name"},
        {"min", K::Constant, std::nullopt, false, "least value"},
        {"max", K::Constant, std::nullopt, false,
         "largest value; as min for an equation"}}},
  };
}

bool can_repeat(const std::string& table) {
  static const std::vector<std::string> tables = {
      "curves", "films",      "solids", "bodies",  "fillets",   "walls",
      "shells", "fields",     "spines", "support", "responses", "exclude",
      "load",   "constraint", "drop",   "layer"};
  return std::find(tables.begin(), tables.end(), table) != tables.end();
}

KeySpec repeat_key() {
  return {"repeat", K::Counts, D::None, false,
          "makes so many: NAME_1, NAME_2, ..., which know their number as i in "
          "expressions and as {i} in names; [N, M] makes NAME_1_1, ... with i "
          "and j"};
}

}  // namespace

const std::vector<TableSpec>& case_tables() {
  static const std::vector<TableSpec> tables = [] {
    std::vector<TableSpec> all = make_tables();
    for (TableSpec& table : all) {
      if (can_repeat(table.name)) {
        table.keys.push_back(repeat_key());
      }
    }
    return all;
  }();
  return tables;
}

const TableSpec& case_table(const std::string& name) {
  const auto& tables = case_tables();
  return *std::find_if(tables.begin(), tables.end(),
                       [&](const TableSpec& t) { return name == t.name; });
}

const KeySpec* find_key(const TableSpec& table, const std::string& key) {
  const auto at = std::find_if(table.keys.begin(), table.keys.end(),
                               [&](const KeySpec& k) { return key == k.key; });
  return at == table.keys.end() ? nullptr : &*at;
}

std::vector<std::string> split_choices(const std::string& choices) {
  std::vector<std::string> parts;
  std::string rest = choices;
  while (!rest.empty()) {
    const std::size_t bar = rest.find('|');
    parts.push_back(rest.substr(0, bar));
    rest = bar == std::string::npos ? "" : rest.substr(bar + 1);
  }
  return parts;
}

std::string either_of(std::vector<std::string> names) {
  const std::string last = std::move(names.back());
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

bool is_entry_table(const std::string& name) {
  return name == "support" || name == "load" || name == "exclude" ||
         name == "plane" || name == "constraint" || name == "drop" ||
         name == "layer";
}

bool is_later_table(const std::string& name) {
  constexpr std::array<const char*, 3> kLater = {"regions", "family", "sweep"};
  return std::find(kLater.begin(), kLater.end(), name) != kLater.end();
}

}  // namespace meniscus::reader
