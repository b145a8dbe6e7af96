#include "pipeline/case_schema.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace meniscus {

namespace {

using D = Dimension;
using K = KeyType;

std::vector<TableSpec> make_tables() {
  return {
      {"",
       false,
       true,
       "Top of the file",
       {{"title", K::Text, D::None, true, "one line for people"},
        {"units", K::Choice, D::None, true,
         "consistent unit system of every number in the file",
         "mm-N-MPa|m-N-Pa|in-lbf-psi"}}},
      {"parameters",
       false,
       false,
       "Named numbers for expressions, `name = value`; override from outside "
       "with --set name=value",
       {}},
      {"design",
       true,
       false,
       "A design variable: what the optimizer moves",
       {{"initial", K::Number, D::None, true,
         "value at which the model freezes and the study starts"},
        {"bounds", K::Bounds, D::None, true, "[least, largest]"}}},
      {"curves",
       true,
       true,
       "A closed boundary curve that holds films; counter-clockwise seen from "
       "the tip of its normal",
       {{"kind", K::Choice, D::None, true, "its shape",
         "circle|ellipse|rectangle|polygon"},
        {"center", K::Vector, D::Length, false,
         "of circle, ellipse, rectangle"},
        {"normal", K::Vector, D::None, false,
         "of circle, ellipse, rectangle; any length but 0"},
        {"axis", K::Vector, D::None, false,
         "of ellipse, rectangle: direction of radius_1 or width"},
        {"radius", K::Quantity, D::Length, false, "of circle"},
        {"radius_1", K::Quantity, D::Length, false, "of ellipse, along axis"},
        {"radius_2", K::Quantity, D::Length, false, "of ellipse, across axis"},
        {"width", K::Quantity, D::Length, false, "of rectangle, along axis"},
        {"height", K::Quantity, D::Length, false, "of rectangle, across axis"},
        {"corner_radius", K::Quantity, D::Length, false,
         "of rectangle; 0 when left out"},
        {"points", K::Vectors, D::Length, false, "of polygon, in order"}}},
      {"films",
       true,
       true,
       "A liquid film between curves",
       {{"kind", K::Choice, D::None, true,
         "how the liquid starts: branch (convex hull of any number of curves "
         "less their caps), loft (band between two), disk (across one)",
         "branch|loft|disk"},
        {"curves", K::Names, D::None, true, "the curves that hold it"},
        {"tension", K::Quantity, D::Tension, false,
         "energy per area of the whole film; 1 when left out"}}},
      {"solids",
       true,
       false,
       "A solid surface, named so that loads find it",
       {{"kind", K::Choice, D::None, true,
         "cap: flat disk across a planar "
         "curve",
         "cap"},
        {"curve", K::Name, D::None, true, "the cap's rim"}}},
      {"bodies",
       true,
       true,
       "A chamber that films and solids enclose; it becomes solid material",
       {{"enclosed_by", K::Names, D::None, true,
         "films and solids that close it"},
        {"volume", K::Quantity, D::Volume, false, "enclosed volume"},
        {"pressure", K::Quantity, D::Pressure, false,
         "inside minus outside, instead of a volume"},
        {"material", K::Name, D::None, true, "what fills it"}}},
      {"resolution",
       false,
       true,
       "Edge lengths",
       {{"fea", K::Number, D::Length, true,
         "of the settled film that is filled with elements"},
        {"film", K::Number, D::Length, false,
         "of its nested refinement, fea / 2, fea / 4, ...; fea / 2 when left "
         "out"},
        {"export", K::Numbers, D::Length, false,
         "of the STL files, each settled again; the film's own when left "
         "out"}}},
      {"materials",
       true,
       true,
       "An isotropic linear-elastic material",
       {{"youngs_modulus", K::Quantity, D::Pressure, true, "above 0"},
        {"poisson_ratio", K::Quantity, D::None, true, "above -1 and below 0.5"},
        {"density", K::Quantity, D::Density, true, "mass per volume"},
        {"yield_strength", K::Quantity, D::Pressure, false,
         "stress above it is warned of"}}},
      {"load_cases",
       true,
       true,
       "Supports and loads that act together",
       {{"supports", K::Supports, D::None, true, "at least one"},
        {"loads", K::Loads, D::None, true, "at least one"}}},
      {"support",
       false,
       false,
       "An entry of `supports`",
       {{"on", K::Name, D::None, true, "the surface that is held"},
        {"fix", K::Text, D::None, true,
         "components held at 0: some of \"xyz\""}}},
      {"load",
       false,
       false,
       "An entry of `loads`; force or pressure",
       {{"on", K::Name, D::None, true, "the surface that is loaded"},
        {"force", K::Vector, D::Force, false,
         "total, spread as uniform traction"},
        {"pressure", K::Quantity, D::Pressure, false,
         "positive into the material"}}},
      {"responses",
       true,
       true,
       "A number that the solver reports",
       {{"kind", K::Choice, D::None, true,
         "mean_displacement: area-weighted over a surface along a direction; "
         "strain_energy: of a load case; film_area: of all films",
         "mean_displacement|mass|volume|max_von_mises|strain_energy|"
         "film_area"},
        {"on", K::Name, D::None, false, "of mean_displacement: the surface"},
        {"direction", K::Vector, D::None, false,
         "of mean_displacement; any length but 0"},
        {"load_case", K::Name, D::None, false,
         "of mean_displacement, max_von_mises, strain_energy; the first when "
         "left out"}}},
      {"study",
       false,
       false,
       "What to do; analyse the initial design when left out",
       {{"kind", K::Choice, D::None, true, "analyse or match", "analyse|match"},
        {"equal", K::Names, D::None, false,
         "of match: responses to make equal; mismatch |a-b| / ((|a|+|b|)/2)"},
        {"targets", K::NumberMap, D::None, false,
         "of match: response = value; mismatch |a-v| / |v|"},
        {"tolerance", K::Number, D::None, false,
         "largest mismatch accepted; 1e-3 when left out"},
        {"method", K::Text, D::None, false,
         "\"ceres\" (when left out) or one of NLopt's: bobyqa, cobyla, sbplx, "
         "neldermead, direct_l"},
        {"max_evaluations", K::Integer, D::None, false,
         "limit, finite-difference ones included; 100 when left out"}}},
  };
}

const char* type_text(const KeySpec& key) {
  switch (key.type) {
    case K::Text:
      return "text";
    case K::Choice:
      return "choice";
    case K::Name:
      return "name";
    case K::Names:
      return "names";
    case K::Number:
      return "number";
    case K::Integer:
      return "integer";
    case K::Quantity:
      return "quantity";
    case K::Vector:
      return "3 quantities";
    case K::Vectors:
      return "points";
    case K::Bounds:
      return "2 numbers";
    case K::Numbers:
      return "numbers";
    case K::NumberMap:
      return "table";
    case K::Supports:
      return "supports";
    case K::Loads:
      return "loads";
  }
  return "";
}

std::vector<std::string> choices_of(const KeySpec& key) {
  std::vector<std::string> choices;
  std::string rest = key.choices;
  while (!rest.empty()) {
    const std::size_t bar = rest.find('|');
    choices.push_back(rest.substr(0, bar));
    rest = bar == std::string::npos ? "" : rest.substr(bar + 1);
  }
  return choices;
}

using Json = nlohmann::ordered_json;

Json type_schema(const KeySpec& key);

Json object_schema(const TableSpec& table) {
  Json schema = {{"type", "object"}, {"description", table.doc}};
  schema["properties"] = Json::object();
  Json required = Json::array();
  for (const KeySpec& key : table.keys) {
    schema["properties"][key.key] = type_schema(key);
    schema["properties"][key.key]["description"] = key.doc;
    if (key.required) {
      required.push_back(key.key);
    }
  }
  if (!required.empty()) {
    schema["required"] = required;
  }
  schema["additionalProperties"] = false;
  return schema;
}

Json type_schema(const KeySpec& key) {
  const Json quantity = {{"type", {"number", "string"}}};
  const Json number = {{"type", "number"}};
  const Json text = {{"type", "string"}};
  const auto array = [](const Json& items, int least, int most) {
    Json schema = {{"type", "array"}, {"items", items}};
    if (least > 0) {
      schema["minItems"] = least;
    }
    if (most > 0) {
      schema["maxItems"] = most;
    }
    return schema;
  };
  switch (key.type) {
    case K::Text:
    case K::Name:
      return text;
    case K::Choice:
      return {{"enum", choices_of(key)}};
    case K::Names:
      return array(text, 1, 0);
    case K::Number:
      return number;
    case K::Integer:
      return {{"type", "integer"}};
    case K::Quantity:
      return quantity;
    case K::Vector:
      return array(quantity, 3, 3);
    case K::Vectors:
      return array(array(quantity, 3, 3), 3, 0);
    case K::Bounds:
      return array(number, 2, 2);
    case K::Numbers:
      return array(number, 1, 0);
    case K::NumberMap:
      return {{"type", "object"}, {"additionalProperties", number}};
    case K::Supports:
      return array(object_schema(case_table("support")), 1, 0);
    case K::Loads:
      return array(object_schema(case_table("load")), 1, 0);
  }
  return {};
}

}  // namespace

const std::vector<TableSpec>& case_tables() {
  static const std::vector<TableSpec> tables = make_tables();
  return tables;
}

const TableSpec& case_table(const std::string& name) {
  const auto& tables = case_tables();
  return *std::find_if(tables.begin(), tables.end(),
                       [&](const TableSpec& t) { return name == t.name; });
}

bool is_later_table(const std::string& name) {
  constexpr std::array<const char*, 3> kLater = {"walls", "family", "sweep"};
  return std::find(kLater.begin(), kLater.end(), name) != kLater.end();
}

std::string json_schema() {
  Json schema = object_schema(case_table(""));
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Meniscus case file";
  for (const TableSpec& table : case_tables()) {
    const std::string name = table.name;
    if (name.empty() || name == "support" || name == "load") {
      continue;
    }
    if (name == "parameters") {
      schema["properties"][name] = {
          {"type", "object"},
          {"description", table.doc},
          {"additionalProperties", {{"type", {"number", "string"}}}}};
    } else if (table.named_entries) {
      schema["properties"][name] = {
          {"type", "object"}, {"additionalProperties", object_schema(table)}};
    } else {
      schema["properties"][name] = object_schema(table);
    }
    if (table.required) {
      schema["required"].push_back(name);
    }
  }
  return schema.dump(2) + "\n";
}

std::string schema_markdown() {
  std::string text;
  for (const TableSpec& table : case_tables()) {
    const std::string name = table.name;
    const std::string heading = name.empty() ? "Top of the file"
                                : table.named_entries
                                    ? fmt::format("`[{}.NAME]`", name)
                                : name == "support" ? "Entries of `supports`"
                                : name == "load"    ? "Entries of `loads`"
                                                 : fmt::format("`[{}]`", name);
    text += fmt::format("### {}\n\n{}.\n\n", heading, table.doc);
    if (table.keys.empty()) {
      continue;
    }
    text +=
        "| key | type | dimension | needed | meaning |\n|---|---|---|---|"
        "---|\n";
    for (const KeySpec& key : table.keys) {
      std::string choices = key.choices;
      std::replace(choices.begin(), choices.end(), '|', ' ');
      text += fmt::format(
          "| `{}` | {} | {} | {} | {}{} |\n", key.key, type_text(key),
          key.dimension == D::None ? "" : name_of(key.dimension),
          key.required ? "yes" : "", key.doc,
          choices.empty() ||
                  std::string(key.doc).find(choices) != std::string::npos
              ? ""
              : " (" + choices + ")");
    }
    text += "\n";
  }
  return text;
}

}  // namespace meniscus
