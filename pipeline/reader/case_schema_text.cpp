#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/json.h"
#include "pipeline/reader/case_schema.h"

namespace meniscus::reader {

namespace {

using K = KeyType;

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
    case K::NameOrNames:
      return "name or names";
    case K::NamesOrNumbers:
      return "names or numbers";
    case K::Integer:
      return "integer";
    case K::Counts:
    case K::Shape:
      return "integers";
    case K::Flag:
      return "true or false";
    case K::Sides:
      return "true, false or sides";
    case K::Quantity:
      return "quantity";
    case K::Quantities:
      return "quantity or quantities";
    case K::Constant:
      return "constant";
    case K::Place:
      return "quantity of x, y, z";
    case K::Field:
      return "quantity of x, y, z and shapes";
    case K::Vector:
      return "3 quantities";
    case K::Vectors:
    case K::Path:
      return "points";
    case K::Facets:
      return "facets";
    case K::ConstantVector:
      return "3 constants";
    case K::PlaceVector:
      return "3 quantities of x, y, z";
    case K::Axes:
      return "2 directions";
    case K::Rims:
      return "base, seat or quantity; edges";
    case K::Elements:
      return "constant or arrays";
    case K::Bounds:
      return "2 constants or arrays";
    case K::Constants:
      return "constants";
    case K::ConstantMap:
    case K::IntegerMap:
      return "table";
    case K::Start:
      return "text or table";
    case K::Supports:
      return "supports";
    case K::Loads:
      return "loads";
    case K::Zones:
      return "zones";
    case K::Spheroids:
      return "spheroids";
    case K::Layers:
      return "layers";
    case K::Planes:
      return "planes";
    case K::Constraints:
      return "constraints";
    case K::Members:
      return "tables or text";
  }
  return "";
}

const char* dimension_text(const KeySpec& key) {
  const bool quantity =
      key.type != K::Text && key.type != K::Choice && key.type != K::Name &&
      key.type != K::Names && key.type != K::NameOrNames &&
      key.type != K::NamesOrNumbers && key.type != K::Integer &&
      key.type != K::Counts && key.type != K::Shape && key.type != K::Facets &&
      key.type != K::Flag && key.type != K::Sides &&
      key.type != K::IntegerMap && key.type != K::Supports &&
      key.type != K::Loads && key.type != K::Zones &&
      key.type != K::Spheroids && key.type != K::Layers &&
      key.type != K::Planes && key.type != K::Constraints &&
      key.type != K::Members;
  if (key.type == K::ConstantMap) {
    return "the response's";
  }
  return !quantity ? "" : key.dimension ? name_of(*key.dimension) : "any";
}

std::string meaning_text(const KeySpec& key) {
  std::string text = key.doc;
  const std::vector<std::string> choices = split_choices(key.choices);
  if (!choices.empty()) {
    text += fmt::format("; one of `{}`", fmt::join(choices, "`, `"));
  }
  for (std::size_t at = text.find('|'); at != std::string::npos;
       at = text.find('|', at + 2)) {
    text.insert(at, 1, '\\');  // or it ends the table's cell
  }
  return text;
}

std::string heading(const TableSpec& table) {
  const std::string name = table.name;
  if (name.empty()) {
    return "Top of the file";
  }
  if (is_entry_table(name)) {
    return fmt::format("Entries of `{}{}`", name,
                       name == "exclude" || name == "drop" ? "" : "s");
  }
  return fmt::format("`[{}{}]`", name, table.named_entries ? ".NAME" : "");
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

Json counts_schema() {
  const Json count = {{"type", {"integer", "string"}}};
  const Json several = {
      {"type", "array"}, {"items", count}, {"minItems", 1}, {"maxItems", 3}};
  return {{"anyOf", {count, several}}};
}

/// A constant, or arrays of them up to three deep.
Json elements_schema() {
  const Json constant = {{"type", {"number", "string"}}};
  Json schema = constant;
  for (int level = 0; level < 3; ++level) {
    const Json several = {
        {"type", "array"}, {"items", schema}, {"minItems", 1}};
    schema = {{"anyOf", {constant, several}}};
  }
  return schema;
}

/// { `key` = item, repeat = n } in a list.
Json repeated(const char* key, const Json& item) {
  return {{"type", "object"},
          {"properties", {{key, item}, {"repeat", counts_schema()}}},
          {"required", {key, "repeat"}},
          {"additionalProperties", false}};
}

Json type_schema(const KeySpec& key) {
  Json quantity = {{"type", {"number", "string"}}};
  Json text = {{"type", "string"}};
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
      return {{"enum", split_choices(key.choices)}};
    case K::Names:
      return array({{"anyOf", {text, repeated("name", text)}}}, 1, 0);
    case K::NameOrNames: {
      const Json several =
          array({{"anyOf", {text, repeated("name", text)}}}, 1, 0);
      return {{"anyOf", {text, several}}};
    }
    case K::NamesOrNumbers: {
      const Json one = {{"type", {"string", "integer"}}};
      return {{"anyOf", {one, array(one, 1, 0)}}};
    }
    case K::Integer:
      return {{"type", "integer"}};
    case K::Counts:
      return counts_schema();
    case K::Shape: {
      const Json count = {{"type", "integer"}, {"minimum", 1}};
      return {{"anyOf", {count, array(count, 1, 3)}}};
    }
    case K::Flag:
      return {{"type", "boolean"}};
    case K::Sides:
      return {{"anyOf",
               {{{"type", "boolean"}},
                array({{"type", "integer"}, {"minimum", 1}}, 1, 0)}}};
    case K::Quantity:
    case K::Constant:
    case K::Place:
    case K::Field:
      return quantity;
    case K::Quantities:
      return {{"anyOf", {quantity, array(quantity, 1, 0)}}};
    case K::Vector:
    case K::ConstantVector:
    case K::PlaceVector:
      return array(quantity, 3, 3);
    case K::Axes:
      return array(array(quantity, 3, 3), 2, 2);
    case K::Vectors: {
      const Json point = array(quantity, 3, 3);
      return array({{"anyOf", {point, repeated("at", point)}}}, 1, 0);
    }
    case K::Facets:
      return array(array({{"type", "integer"}, {"minimum", 0}}, 3, 0), 1, 0);
    case K::Path: {
      const Json point = array(quantity, 3, 3);
      const Json arc = {{"type", "object"},
                        {"properties", {{"through", point}}},
                        {"required", {"through"}},
                        {"additionalProperties", false}};
      return array({{"anyOf", {point, arc, repeated("at", point)}}}, 1, 0);
    }
    case K::Rims:
      return array(
          {{"anyOf",
            {quantity, array({{"type", {"string", "integer"}}}, 1, 0)}}},
          1, 0);
    case K::Elements:
      return elements_schema();
    case K::Bounds:
      return array(elements_schema(), 2, 2);
    case K::Constants:
      return array(quantity, 1, 0);
    case K::ConstantMap:
      return {{"type", "object"}, {"additionalProperties", quantity}};
    case K::IntegerMap:
      return {{"type", "object"},
              {"additionalProperties", {{"type", "integer"}}}};
    case K::Start:
      return {{"type", {"string", "object"}},
              {"additionalProperties", elements_schema()}};
    case K::Supports:
      return array(object_schema(case_table("support")), 1, 0);
    case K::Loads:
      return array(object_schema(case_table("load")), 1, 0);
    case K::Zones:
      return array(object_schema(case_table("exclude")), 1, 0);
    case K::Spheroids:
      return array(object_schema(case_table("drop")), 1, 0);
    case K::Layers:
      return array(object_schema(case_table("layer")), 1, 0);
    case K::Planes:
      return array(object_schema(case_table("plane")), 1, 3);
    case K::Constraints:
      return array(object_schema(case_table("constraint")), 1, 0);
    case K::Members:
      return {{"type", {"string", "object"}},
              {"additionalProperties", {{"type", "object"}}}};
  }
  return {};
}

}  // namespace

std::string json_schema() {
  Json schema = object_schema(case_table(""));
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Meniscus case file";
  Json for_parts = Json::array();
  for (const TableSpec& table : case_tables()) {
    const std::string name = table.name;
    if (name.empty() || is_entry_table(name)) {
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
    if (table.need == TableNeed::Always) {
      schema["required"].push_back(name);
    } else if (table.need == TableNeed::ForParts) {
      for_parts.push_back(name);
    }
  }
  schema["anyOf"] = {{{"required", for_parts}},
                     {{"required", {"walls"}}},
                     {{"required", {"shells"}}}};
  return json_text(schema, 2) + "\n";
}

std::string schema_markdown() {
  std::string text;
  for (const TableSpec& table : case_tables()) {
    text += fmt::format("### {}\n\n{}.\n\n", heading(table), table.doc);
    if (table.keys.empty()) {
      continue;
    }
    text +=
        "| key | type | dimension | needed | meaning |\n|---|---|---|---|"
        "---|\n";
    for (const KeySpec& key : table.keys) {
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.key,
                          type_text(key), dimension_text(key),
                          key.required ? "yes" : "", meaning_text(key));
    }
    text += "\n";
  }
  text.pop_back();  // one end of line is enough
  return text;
}

}  // namespace meniscus::reader
