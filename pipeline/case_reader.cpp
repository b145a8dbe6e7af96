#include "pipeline/case_reader.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.h"
#include "pipeline/case_checks.h"
#include "pipeline/case_schema.h"
#include "pipeline/content_hash.h"

namespace meniscus {

namespace {

constexpr std::size_t kLargestFile = 4u << 20;  // byte; cases are kilobytes

int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}

const char* type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

/// Turns checked TOML into a Case, collecting problems on the way.
class Reader {
 public:
  Reader(CaseProblems& problems, Case& result)
      : problems_(problems), case_(result) {}

  void read(const toml::table& root);

 private:
  using Entry = std::pair<std::string, const toml::table*>;

  void problem(int line, const std::string& message) {
    problems_.add(line, message);
  }
  void check_keys(const toml::table& table, const TableSpec& spec,
                  const std::string& path, int line);
  void check_top(const toml::table& root);
  std::vector<Entry> entries(const toml::table& root, const char* table);
  void check_name(const std::string& name, const std::string& path, int line);

  std::string text(const toml::table& table, const char* key,
                   const std::string& path);
  std::string choice(const toml::table& table, const TableSpec& spec,
                     const char* key, const std::string& path);
  std::vector<std::string> names(const toml::table& table, const char* key,
                                 const std::string& path);
  std::optional<double> number(const toml::node* node, const std::string& path);
  std::vector<double> numbers(const toml::table& table, const char* key,
                              const std::string& path, std::size_t count);
  Quantity quantity(const toml::node& node, Dimension dimension,
                    const std::string& path);
  std::optional<Quantity> quantity(const toml::table& table, const char* key,
                                   Dimension dimension,
                                   const std::string& path);
  Quantity needed(const toml::table& table, const char* key,
                  Dimension dimension, const std::string& path);
  QuantityVector vector(const toml::node& node, Dimension dimension,
                        const std::string& path);
  QuantityVector vector(const toml::table& table, const char* key,
                        Dimension dimension, const std::string& path);

  void read_names(const toml::table& root);
  void read_parameters(const toml::table& root);
  void read_curves(const toml::table& root);
  void read_films(const toml::table& root);
  void read_bodies(const toml::table& root);
  void read_materials(const toml::table& root);
  void read_resolution(const toml::table& root);
  void read_load_cases(const toml::table& root);
  LoadEntry read_load(const toml::table& load, const std::string& path);
  Support read_support(const toml::table& support, const std::string& path);
  void read_responses(const toml::table& root);
  void read_study(const toml::table& root);
  int index_of_load_case(const toml::table& table, const std::string& path);

  CaseProblems& problems_;
  Case& case_;
  std::vector<std::string> names_;  // that expressions know, by position
};

void Reader::check_keys(const toml::table& table, const TableSpec& spec,
                        const std::string& path, int line) {
  std::vector<std::string> known;
  for (const KeySpec& key : spec.keys) {
    known.emplace_back(key.key);
    if (key.required && !table.contains(key.key)) {
      problem(line, fmt::format("{} has no '{}' ({}); add it", path, key.key,
                                key.doc));
    }
  }
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest_name(name, known);
      problem(line_of(node),
              fmt::format(
                  "unknown key '{}' in {}; {}", name, path,
                  near.empty()
                      ? "known are " + fmt::format("{}", fmt::join(known, ", "))
                      : "did you mean '" + near + "'?"));
    }
  }
}

void Reader::check_top(const toml::table& root) {
  std::vector<std::string> known;
  for (const TableSpec& spec : case_tables()) {
    const std::string name = spec.name;
    if (name.empty()) {
      for (const KeySpec& key : spec.keys) {
        known.emplace_back(key.key);
        if (!root.contains(key.key)) {
          problem(1, fmt::format("the file has no '{}' ({}); add it", key.key,
                                 key.doc));
        }
      }
    } else if (name != "support" && name != "load") {
      known.push_back(name);
      if (spec.required && !root.contains(name)) {
        problem(1, fmt::format("the file has no [{}{}] ({}); add one", name,
                               spec.named_entries ? ".NAME" : "", spec.doc));
      }
    }
  }
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    if (is_later_table(name)) {
      problem(line_of(node),
              fmt::format("[{}] is not available in this version", name));
    } else if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest_name(name, known);
      problem(
          line_of(node),
          fmt::format(
              "unknown {} '{}'; {}", node.is_table() ? "table" : "key", name,
              near.empty() ? fmt::format("known are {}", fmt::join(known, ", "))
                           : "did you mean '" + near + "'?"));
    }
  }
}

std::vector<Reader::Entry> Reader::entries(const toml::table& root,
                                           const char* table) {
  std::vector<Entry> found;
  const toml::node* node = root.get(table);
  if (node == nullptr) {
    return found;
  }
  const toml::table* all = node->as_table();
  if (all == nullptr) {
    problem(line_of(*node), fmt::format("{} is {}; expected tables [{}.NAME]",
                                        table, type_name(*node), table));
    return found;
  }
  for (const auto& [key, entry] : *all) {
    const std::string name(key.str());
    const std::string path = fmt::format("{}.{}", table, name);
    if (const toml::table* inner = entry.as_table()) {
      check_name(name, path, line_of(entry));
      check_keys(*inner, case_table(table), path, line_of(entry));
      found.emplace_back(name, inner);
    } else {
      problem(line_of(entry), fmt::format("{} is {}; expected a table [{}]",
                                          path, type_name(entry), path));
    }
  }
  // toml++ sorts by name; the file's order is what people see.
  std::stable_sort(found.begin(), found.end(),
                   [](const Entry& a, const Entry& b) {
                     return line_of(*a.second) < line_of(*b.second);
                   });
  return found;
}

void Reader::check_name(const std::string& name, const std::string& path,
                        int line) {
  const bool good = !name.empty() && !(name[0] >= '0' && name[0] <= '9') &&
                    std::all_of(name.begin(), name.end(), [](char c) {
                      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                             (c >= '0' && c <= '9') || c == '_';
                    });
  if (!good) {
    problem(line, fmt::format("{}: a name is made of letters, digits and _ "
                              "and starts with no digit",
                              path));
  }
}

std::string Reader::text(const toml::table& table, const char* key,
                         const std::string& path) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    return "";
  }
  if (const auto* value = node->as_string()) {
    return value->get();
  }
  problem(line_of(*node), fmt::format("{}.{} is {}; expected text in quotes",
                                      path, key, type_name(*node)));
  return "";
}

std::string Reader::choice(const toml::table& table, const TableSpec& spec,
                           const char* key, const std::string& path) {
  const std::string value = text(table, key, path);
  if (value.empty()) {
    return value;
  }
  const auto at = std::find_if(
      spec.keys.begin(), spec.keys.end(),
      [&](const KeySpec& k) { return std::string_view(k.key) == key; });
  std::vector<std::string> choices;
  std::stringstream stream(at->choices);
  for (std::string one; std::getline(stream, one, '|');) {
    choices.push_back(one);
  }
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
    problem(line_of(*table.get(key)),
            fmt::format("{}.{} is '{}'; expected one of {}", path, key, value,
                        fmt::join(choices, ", ")));
    return "";
  }
  return value;
}

std::vector<std::string> Reader::names(const toml::table& table,
                                       const char* key,
                                       const std::string& path) {
  std::vector<std::string> result;
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    return result;
  }
  const toml::array* array = node->as_array();
  bool good = array != nullptr && !array->empty();
  for (std::size_t k = 0; good && k < array->size(); ++k) {
    const auto* name = array->get(k)->as_string();
    good = name != nullptr;
    if (good) {
      result.push_back(name->get());
    }
  }
  if (!good) {
    problem(line_of(*node), fmt::format("{}.{} is {}; expected names: [\"a\", "
                                        "\"b\"]",
                                        path, key, type_name(*node)));
    result.clear();
  }
  return result;
}

std::optional<double> Reader::number(const toml::node* node,
                                     const std::string& path) {
  if (node == nullptr) {
    return std::nullopt;
  }
  if (const auto value = node->value<double>();
      value && node->is_number() && std::isfinite(*value)) {
    return value;
  }
  problem(line_of(*node), fmt::format("{} is {}; expected a finite number",
                                      path, type_name(*node)));
  return std::nullopt;
}

std::vector<double> Reader::numbers(const toml::table& table, const char* key,
                                    const std::string& path,
                                    std::size_t count) {
  std::vector<double> result;
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    return result;
  }
  const toml::array* array = node->as_array();
  if (array == nullptr || (count > 0 && array->size() != count)) {
    problem(line_of(*node),
            fmt::format("{}.{} is {}; expected an array of {} numbers", path,
                        key, type_name(*node),
                        count > 0 ? fmt::format("{}", count) : "some"));
    return result;
  }
  for (const toml::node& item : *array) {
    if (const auto value = number(&item, fmt::format("{}.{}", path, key))) {
      result.push_back(*value);
    }
  }
  if (result.size() != array->size()) {
    result.clear();
  }
  return result;
}

Quantity Reader::quantity(const toml::node& node, Dimension dimension,
                          const std::string& path) {
  Quantity result{.line = line_of(node), .key = path};
  if (node.is_number()) {
    if (const auto value = number(&node, path)) {
      result.expression = Expression(*value);
    }
    return result;
  }
  const auto* string = node.as_string();
  if (string == nullptr) {
    problem(result.line,
            fmt::format("{} is {}; expected a number, an expression in quotes "
                        "or a value with a unit",
                        path, type_name(node)));
    return result;
  }
  try {
    result.expression =
        looks_like_quantity(string->get())
            ? Expression(parse_quantity(string->get(), dimension, case_.units))
            : Expression::parse(string->get(), names_);
  } catch (const ExpressionError& error) {
    problem(result.line, fmt::format("{}: {} at character {}", path,
                                     error.what(), error.column()));
  } catch (const InvalidInput& error) {
    problem(result.line, fmt::format("{}: {}", path, error.what()));
  }
  return result;
}

std::optional<Quantity> Reader::quantity(const toml::table& table,
                                         const char* key, Dimension dimension,
                                         const std::string& path) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  return quantity(*node, dimension, fmt::format("{}.{}", path, key));
}

/// A missing one has been reported already, or is by need_keys().
Quantity Reader::needed(const toml::table& table, const char* key,
                        Dimension dimension, const std::string& path) {
  return quantity(table, key, dimension, path)
      .value_or(Quantity{.line = line_of(table), .key = path + "." + key});
}

QuantityVector Reader::vector(const toml::node& node, Dimension dimension,
                              const std::string& path) {
  QuantityVector result;
  for (Quantity& component : result) {
    component.line = line_of(node);
    component.key = path;
  }
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 3) {
    problem(line_of(node),
            fmt::format("{} is {}; expected [x, y, z]", path, type_name(node)));
    return result;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = quantity(*array->get(k), dimension, path);
  }
  return result;
}

QuantityVector Reader::vector(const toml::table& table, const char* key,
                              Dimension dimension, const std::string& path) {
  const toml::node* node = table.get(key);
  if (node == nullptr) {
    QuantityVector zero;
    for (Quantity& component : zero) {
      component.line = line_of(table);
      component.key = path + "." + key;
    }
    return zero;
  }
  return vector(*node, dimension, fmt::format("{}.{}", path, key));
}

void Reader::read_names(const toml::table& root) {
  std::map<std::string, int> seen;
  const auto claim = [&](const std::string& name, int line) {
    if (is_reserved_name(name)) {
      problem(line, fmt::format("'{}' is a name that expressions know already; "
                                "choose another",
                                name));
    } else if (!seen.emplace(name, line).second) {
      problem(line, fmt::format("'{}' is both a parameter and a design "
                                "variable (line {}); rename one",
                                name, seen[name]));
    }
    names_.push_back(name);
  };
  for (const auto& [name, table] : entries(root, "design")) {
    const std::string path = "design." + name;
    claim(name, line_of(*table));
    DesignVariable variable{.name = name, .line = line_of(*table)};
    variable.initial =
        number(table->get("initial"), path + ".initial").value_or(0.0);
    const std::vector<double> bounds = numbers(*table, "bounds", path, 2);
    if (bounds.size() == 2) {
      variable.lower = bounds[0];
      variable.upper = bounds[1];
      check_bounds(variable, line_of(*table->get("bounds")), problems_);
    }
    case_.design.push_back(variable);
  }
  if (const toml::table* parameters = root["parameters"].as_table()) {
    for (const auto& [key, node] : *parameters) {
      check_name(std::string(key.str()), "parameters." + std::string(key.str()),
                 line_of(node));
      claim(std::string(key.str()), line_of(node));
    }
  } else if (root.contains("parameters")) {
    problem(line_of(*root.get("parameters")),
            "parameters must be a table [parameters] with name = value");
  }
}

void Reader::read_parameters(const toml::table& root) {
  const toml::table* table = root["parameters"].as_table();
  if (table == nullptr) {
    return;
  }
  for (const auto& [key, node] : *table) {
    const std::string name(key.str());
    case_.parameters.push_back(
        {name, quantity(node, Dimension::None, "parameters." + name)});
  }
}

void Reader::read_curves(const toml::table& root) {
  static const std::map<std::string, CurveKind> kinds = {
      {"circle", CurveKind::Circle},
      {"ellipse", CurveKind::Ellipse},
      {"rectangle", CurveKind::Rectangle},
      {"polygon", CurveKind::Polygon}};
  static const std::map<CurveKind, std::vector<const char*>> needs = {
      {CurveKind::Circle, {"center", "normal", "radius"}},
      {CurveKind::Ellipse,
       {"center", "normal", "axis", "radius_1", "radius_2"}},
      {CurveKind::Rectangle, {"center", "normal", "axis", "width", "height"}},
      {CurveKind::Polygon, {"points"}}};
  for (const auto& [name, table] : entries(root, "curves")) {
    const std::string path = "curves." + name;
    const std::string kind = choice(*table, case_table("curves"), "kind", path);
    if (kind.empty()) {
      continue;
    }
    CurveEntry curve{
        .name = name, .kind = kinds.at(kind), .line = line_of(*table)};
    std::vector<const char*> allowed = needs.at(curve.kind);
    for (const char* key : allowed) {
      if (!table->contains(key)) {
        problem(curve.line, fmt::format("{} is a {} and has no '{}'; add it",
                                        path, kind, key));
      }
    }
    allowed.push_back("kind");
    if (curve.kind == CurveKind::Rectangle) {
      allowed.push_back("corner_radius");
    }
    for (const auto& [key, node] : *table) {
      const bool fits =
          std::any_of(allowed.begin(), allowed.end(),
                      [&, k = key.str()](const char* a) { return k == a; });
      const auto& keys = case_table("curves").keys;
      const bool known = std::any_of(
          keys.begin(), keys.end(),
          [&, k = key.str()](const KeySpec& s) { return k == s.key; });
      if (known && !fits) {
        problem(line_of(node), fmt::format("{}.{} does not belong to a {}",
                                           path, key.str(), kind));
      }
    }
    curve.center = vector(*table, "center", Dimension::Length, path);
    curve.normal = vector(*table, "normal", Dimension::None, path);
    curve.axis = vector(*table, "axis", Dimension::None, path);
    curve.radius = needed(*table, "radius", Dimension::Length, path);
    curve.radius_1 = needed(*table, "radius_1", Dimension::Length, path);
    curve.radius_2 = needed(*table, "radius_2", Dimension::Length, path);
    curve.width = needed(*table, "width", Dimension::Length, path);
    curve.height = needed(*table, "height", Dimension::Length, path);
    curve.corner_radius =
        needed(*table, "corner_radius", Dimension::Length, path);
    if (const toml::array* points = (*table)["points"].as_array()) {
      for (const toml::node& point : *points) {
        curve.points.push_back(
            vector(point, Dimension::Length, path + ".points"));
      }
    }
    case_.curves.push_back(std::move(curve));
  }
}

void Reader::read_films(const toml::table& root) {
  static const std::map<std::string, FilmKind> kinds = {
      {"branch", FilmKind::Branch},
      {"loft", FilmKind::Loft},
      {"disk", FilmKind::Disk}};
  for (const auto& [name, table] : entries(root, "films")) {
    const std::string path = "films." + name;
    const std::string kind = choice(*table, case_table("films"), "kind", path);
    FilmEntry film{.line = line_of(*table)};
    film.spec.name = name;
    film.spec.kind = kind.empty() ? FilmKind::Branch : kinds.at(kind);
    film.spec.curves = names(*table, "curves", path);
    film.tension = quantity(*table, "tension", Dimension::Tension, path)
                       .value_or(Quantity{.expression = Expression(1.0),
                                          .line = film.line,
                                          .key = path + ".tension"});
    case_.films.push_back(std::move(film));
  }
  for (const auto& [name, table] : entries(root, "solids")) {
    const std::string path = "solids." + name;
    choice(*table, case_table("solids"), "kind", path);
    CapEntry cap{.line = line_of(*table)};
    cap.spec = {name, text(*table, "curve", path)};
    case_.caps.push_back(std::move(cap));
  }
}

void Reader::read_materials(const toml::table& root) {
  for (const auto& [name, table] : entries(root, "materials")) {
    const std::string path = "materials." + name;
    MaterialEntry material{.name = name, .line = line_of(*table)};
    material.youngs_modulus =
        needed(*table, "youngs_modulus", Dimension::Pressure, path);
    material.poisson_ratio =
        needed(*table, "poisson_ratio", Dimension::None, path);
    material.density = needed(*table, "density", Dimension::Density, path);
    material.yield_strength =
        quantity(*table, "yield_strength", Dimension::Pressure, path);
    case_.materials.push_back(std::move(material));
  }
}

void Reader::read_bodies(const toml::table& root) {
  for (const auto& [name, table] : entries(root, "bodies")) {
    const std::string path = "bodies." + name;
    BodyEntry body{.name = name, .line = line_of(*table)};
    body.enclosed_by = names(*table, "enclosed_by", path);
    body.volume = quantity(*table, "volume", Dimension::Volume, path);
    body.pressure = quantity(*table, "pressure", Dimension::Pressure, path);
    if (body.volume && body.pressure) {
      problem(body.line, path + " has both a volume and a pressure; keep one");
    }
    const std::string material = text(*table, "material", path);
    if (!material.empty()) {
      const auto at = std::find_if(
          case_.materials.begin(), case_.materials.end(),
          [&](const MaterialEntry& m) { return m.name == material; });
      if (at == case_.materials.end()) {
        std::vector<std::string> known;
        for (const MaterialEntry& m : case_.materials) {
          known.push_back(m.name);
        }
        problems_.unknown(line_of(*table->get("material")), "material",
                          material, known);
      } else {
        body.material = static_cast<int>(at - case_.materials.begin());
      }
    }
    case_.bodies.push_back(std::move(body));
  }
}

void Reader::read_resolution(const toml::table& root) {
  const toml::node* node = root.get("resolution");
  if (node == nullptr) {
    return;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    problem(line_of(*node), "resolution must be a table [resolution]");
    return;
  }
  check_keys(*table, case_table("resolution"), "resolution", line_of(*node));
  Resolution& resolution = case_.resolution;
  const auto length = [&](const char* key) {
    const auto value =
        number(table->get(key), fmt::format("resolution.{}", key));
    if (value && !(*value > 0.0)) {
      problem(line_of(*table->get(key)),
              fmt::format("resolution.{} is {:g}; an edge length is above 0",
                          key, *value));
    }
    return value.value_or(0.0);
  };
  resolution.fea = length("fea");
  resolution.film =
      table->contains("film") ? length("film") : resolution.fea / 2.0;
  resolution.export_edges = numbers(*table, "export", "resolution", 0);
  for (const double edge : resolution.export_edges) {
    if (!(edge > 0.0)) {
      problem(line_of(*table->get("export")),
              fmt::format("resolution.export holds {:g}; an edge length is "
                          "above 0",
                          edge));
    }
  }
  check_nesting(resolution, line_of(*node), problems_);
}

Support Reader::read_support(const toml::table& support,
                             const std::string& path) {
  check_keys(support, case_table("support"), path, line_of(support));
  Support result{.surface = text(support, "on", path)};
  for (const char c : text(support, "fix", path)) {
    result.fix_x = result.fix_x || c == 'x';
    result.fix_y = result.fix_y || c == 'y';
    result.fix_z = result.fix_z || c == 'z';
    if (c != 'x' && c != 'y' && c != 'z') {
      problem(
          line_of(support),
          fmt::format("{}.fix holds '{}'; expected some of \"xyz\"", path, c));
    }
  }
  return result;
}

LoadEntry Reader::read_load(const toml::table& load, const std::string& path) {
  check_keys(load, case_table("load"), path, line_of(load));
  LoadEntry result{.surface = text(load, "on", path)};
  if (load.contains("force")) {
    result.force = vector(load, "force", Dimension::Force, path);
  }
  result.pressure = quantity(load, "pressure", Dimension::Pressure, path);
  if (result.force.has_value() == result.pressure.has_value()) {
    problem(line_of(load),
            fmt::format("{} needs either a force or a pressure", path));
    result.pressure.reset();
    result.force.emplace();
  }
  return result;
}

void Reader::read_load_cases(const toml::table& root) {
  for (const auto& [name, table] : entries(root, "load_cases")) {
    const std::string path = "load_cases." + name;
    LoadCaseEntry load_case{.name = name, .line = line_of(*table)};
    const auto each = [&](const char* key, const auto& read_one) {
      const toml::node* node = table->get(key);
      if (node == nullptr) {
        return;
      }
      const toml::array* array = node->as_array();
      if (array == nullptr || array->empty()) {
        problem(line_of(*node),
                fmt::format("{}.{} must be an array of tables, at least one: "
                            "[{{ on = ... }}]",
                            path, key));
        return;
      }
      for (const toml::node& item : *array) {
        if (const toml::table* one = item.as_table()) {
          read_one(*one, fmt::format("{}.{}", path, key));
        } else {
          problem(line_of(item), fmt::format("{}.{} holds {}; expected tables",
                                             path, key, type_name(item)));
        }
      }
    };
    each("supports", [&](const toml::table& one, const std::string& where) {
      load_case.supports.push_back(read_support(one, where));
      check_surface_name(case_, load_case.supports.back().surface, line_of(one),
                         problems_);
    });
    each("loads", [&](const toml::table& one, const std::string& where) {
      load_case.loads.push_back(read_load(one, where));
      check_surface_name(case_, load_case.loads.back().surface, line_of(one),
                         problems_);
    });
    case_.load_cases.push_back(std::move(load_case));
  }
}

int Reader::index_of_load_case(const toml::table& table,
                               const std::string& path) {
  const std::string name = text(table, "load_case", path);
  if (name.empty()) {
    return 0;
  }
  std::vector<std::string> known;
  for (const LoadCaseEntry& entry : case_.load_cases) {
    if (entry.name == name) {
      return static_cast<int>(known.size());
    }
    known.push_back(entry.name);
  }
  problems_.unknown(line_of(*table.get("load_case")), "load case", name, known);
  return 0;
}

void Reader::read_responses(const toml::table& root) {
  static const std::map<std::string, ResponseKind> kinds = {
      {"mean_displacement", ResponseKind::MeanDisplacement},
      {"mass", ResponseKind::Mass},
      {"volume", ResponseKind::Volume},
      {"max_von_mises", ResponseKind::MaxVonMises},
      {"strain_energy", ResponseKind::StrainEnergy},
      {"film_area", ResponseKind::FilmArea}};
  for (const auto& [name, table] : entries(root, "responses")) {
    const std::string path = "responses." + name;
    const std::string kind =
        choice(*table, case_table("responses"), "kind", path);
    if (kind.empty()) {
      continue;
    }
    ResponseEntry response{
        .name = name, .kind = kinds.at(kind), .line = line_of(*table)};
    const bool mean = response.kind == ResponseKind::MeanDisplacement;
    for (const char* key : {"on", "direction"}) {
      if (mean != table->contains(key)) {
        problem(response.line, fmt::format("{} is a {}: it {} '{}'", path, kind,
                                           mean ? "needs" : "has no", key));
      }
    }
    response.direction = vector(*table, "direction", Dimension::None, path);
    if (mean && table->contains("on")) {
      response.surface = text(*table, "on", path);
      check_surface_name(case_, response.surface, line_of(*table->get("on")),
                         problems_);
    }
    response.load_case = index_of_load_case(*table, path);
    case_.responses.push_back(std::move(response));
  }
}

void Reader::read_study(const toml::table& root) {
  const toml::node* node = root.get("study");
  if (node == nullptr) {
    return;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    problem(line_of(*node), "study must be a table [study]");
    return;
  }
  StudyEntry& study = case_.study;
  study.line = line_of(*node);
  const std::string wanted = text(*table, "kind", "study");
  if (is_later_study(wanted)) {
    problem(line_of(*table->get("kind")),
            fmt::format("study.kind '{}' is not available in this version; "
                        "there are analyse and match",
                        wanted));
    return;
  }
  check_keys(*table, case_table("study"), "study", study.line);
  const std::string kind = choice(*table, case_table("study"), "kind", "study");
  study.kind = kind == "match" ? StudyKind::Match : StudyKind::Analyse;
  study.equal = names(*table, "equal", "study");
  if (const toml::table* targets = (*table)["targets"].as_table()) {
    for (const auto& [key, value] : *targets) {
      study.targets.emplace_back(std::string(key.str()),
                                 number(&value, "study.targets").value_or(0.0));
    }
  } else if (table->contains("targets")) {
    problem(study.line, "study.targets must be a table: { response = value }");
  }
  study.tolerance =
      number(table->get("tolerance"), "study.tolerance").value_or(1e-3);
  if (table->contains("method")) {
    study.method = text(*table, "method", "study");
  }
  if (const toml::node* most = table->get("max_evaluations")) {
    const auto value = most->value<int>();
    if (!value || *value < 1) {
      problem(line_of(*most),
              "study.max_evaluations must be a whole number above 0");
    }
    study.max_evaluations = value.value_or(100);
  }
  check_study(case_, problems_);
}

void Reader::read(const toml::table& root) {
  check_top(root);
  case_.title = text(root, "title", "the file");
  const std::string units = choice(root, case_table(""), "units", "the file");
  case_.units = unit_system(units).value_or(*unit_system("mm-N-MPa"));
  read_names(root);
  read_parameters(root);
  read_curves(root);
  read_films(root);
  read_materials(root);
  read_bodies(root);
  read_resolution(root);
  read_load_cases(root);
  read_responses(root);
  read_study(root);
}

/// The value of an override as TOML: number, array or boolean as they stand,
/// else text.
toml::table parse_override(const std::string& value) {
  try {
    return toml::parse("value = " + value + "\n");
  } catch (const toml::parse_error&) {
    return toml::table{{"value", value}};
  }
}

/// Every dotted key of the file that holds a value.
void list_keys(const toml::table& table, const std::string& prefix,
               std::vector<std::string>& keys) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      list_keys(*inner, path + ".", keys);
    } else {
      keys.push_back(path);
    }
  }
}

/// Where `name` of an override points: "load_left" -> parameters.load_left.
std::string full_key(const toml::table& root, const std::string& name) {
  if (root.at_path("parameters." + name)) {
    return "parameters." + name;
  }
  if (root.at_path("design." + name + ".initial")) {
    return "design." + name + ".initial";
  }
  return name;
}

void apply_override(toml::table& root, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InvalidInput(fmt::format("--set {}: expected name=value", text));
  }
  const std::string name = text.substr(0, equals);
  const std::string key = full_key(root, name);
  const std::size_t dot = key.rfind('.');
  toml::table* parent = &root;
  if (dot != std::string::npos) {
    parent = root.at_path(key.substr(0, dot)).as_table();
  }
  const std::string last = dot == std::string::npos ? key : key.substr(dot + 1);
  const std::string head = key.substr(0, key.find('.'));
  // A key that is not in the file may be added to a table that is.
  const bool addable =
      dot != std::string::npos && parent != nullptr && head != "parameters";
  if (parent == nullptr || (!parent->contains(last) && !addable)) {
    std::vector<std::string> known;
    list_keys(root, "", known);
    const std::size_t count = known.size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::string& path = known[k];
      if (path.rfind("parameters.", 0) == 0) {
        known.push_back(path.substr(11));
      } else if (path.rfind("design.", 0) == 0 && path.ends_with(".initial")) {
        known.push_back(path.substr(7, path.size() - 15));
      }
    }
    const std::string near = nearest_name(name, known);
    throw InvalidInput(fmt::format(
        "--set {}: there is no parameter, design variable or key '{}'{}", text,
        name, near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near)));
  }
  const toml::table value = parse_override(text.substr(equals + 1));
  parent->insert_or_assign(last, *value.get("value"));
}

}  // namespace

CaseReading read_case_text(const std::string& text, const std::string& path,
                           const std::vector<std::string>& overrides) {
  CaseReading reading;
  Case result;
  result.path = path;
  result.name = case_name(path);
  result.text = text;
  result.overrides = overrides;
  CaseProblems problems(path);
  try {
    toml::table root = toml::parse(text, path);
    for (const std::string& override_text : overrides) {
      apply_override(root, override_text);
    }
    Reader(problems, result).read(root);
    if (problems.empty()) {
      check_case(result, problems);
    }
    std::ostringstream canonical;
    canonical << toml::json_formatter(root);  // keys sorted, no comments
    result.hash = content_hash(canonical.str());
  } catch (const toml::parse_error& error) {
    problems.add(static_cast<int>(error.source().begin.line),
                 fmt::format("this is not TOML: {} (column {})",
                             error.description(), error.source().begin.column));
  } catch (const InvalidInput& error) {
    problems.add_text(error.what());
  }
  reading.problems = problems.take();
  reading.warnings = problems.take_warnings();
  if (reading.problems.empty()) {
    reading.input = std::move(result);
  }
  return reading;
}

CaseReading read_case_file(const std::string& path,
                           const std::vector<std::string>& overrides) {
  namespace fs = std::filesystem;
  CaseReading reading;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    reading.problems.push_back(
        path + " is a folder; name the case file in it (case.toml)");
    return reading;
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    reading.problems.push_back(fmt::format("{}: cannot be read: {}", path,
                                           fs::exists(status)
                                               ? "no permission"
                                               : "there is no such "
                                                 "file"));
    return reading;
  }
  std::string text(kLargestFile + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kLargestFile) {
    reading.problems.push_back(fmt::format(
        "{}: larger than {} MB: not a case file", path, kLargestFile >> 20));
    return reading;
  }
  return read_case_text(text, path, overrides);
}

Case read_case(const std::string& path,
               const std::vector<std::string>& overrides) {
  CaseReading reading = read_case_file(path, overrides);
  if (!reading.input) {
    throw InvalidInput(fmt::format("{}", fmt::join(reading.problems, "\n")));
  }
  return *std::move(reading.input);
}

}  // namespace meniscus
