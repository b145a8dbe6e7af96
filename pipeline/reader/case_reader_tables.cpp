#include "pipeline/reader/case_reader_tables.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "pipeline/case_data/case_checks.h"
#include "pipeline/case_data/case_symmetry.h"

namespace meniscus::reader {

namespace {

void check_top(CaseContext& context, const toml::table& root) {
  const bool only_walls = root.contains("walls") && !root.contains("bodies");
  std::vector<std::string> known;
  for (const TableSpec& spec : case_tables()) {
    const std::string name = spec.name;
    if (name.empty()) {
      for (const KeySpec& key : spec.keys) {
        known.emplace_back(key.key);
        if (!root.contains(key.key)) {
          context.problems.add(1, fmt::format("the file has no '{}' ({}); add "
                                              "it above the first table",
                                              key.key, key.doc));
        }
      }
    } else if (!is_entry_table(name)) {
      known.push_back(name);
      const bool needed = spec.need == TableNeed::Always ||
                          (spec.need == TableNeed::ForParts && !only_walls);
      if (needed && !root.contains(name)) {
        context.problems.add(
            1, fmt::format("the file has no [{}{}] ({}); add one", name,
                           spec.named_entries ? ".NAME" : "", spec.doc));
      }
    }
  }
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    if (is_later_table(name)) {
      context.problems.add(
          context.line_of(node),
          fmt::format("[{}] is not available in this version", name));
    } else if (std::find(known.begin(), known.end(), name) == known.end()) {
      context.problems.add(
          context.line_of(node),
          fmt::format("unknown {} '{}'{}", node.is_table() ? "table" : "key",
                      name, case_data::advice(name, known)));
    }
  }
}

void read_head(CaseContext& context, const toml::table& root,
               case_data::Case& result) {
  const toml::node* title = root.get("title");
  if (title != nullptr) {
    if (const auto* text = title->as_string()) {
      result.title = text->get();
    } else {
      context.problems.add(context.line_of(*title),
                           fmt::format("title is {}; expected text in quotes",
                                       described(*title)));
    }
  }
  context.units = *unit_system("mm-N-MPa");
  if (const toml::node* units = root.get("units")) {
    const auto* text = units->as_string();
    const auto system = unit_system(text == nullptr ? "" : text->get());
    if (system) {
      context.units = *system;
    } else {
      context.problems.add(
          context.line_of(*units),
          fmt::format("units is {}; expected one of {}", described(*units),
                      fmt::join(split_choices(
                                    find_key(case_table(""), "units")->choices),
                                ", ")));
    }
  }
  result.units = context.units;
}

bool is_name(const std::string& name) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !name.empty() && letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return letter(c) || (c >= '0' && c <= '9');
         });
}

void check_name(CaseContext& context, const std::string& name,
                const std::string& table, case_data::SourceLine line) {
  if (!is_name(name)) {
    context.problems.add(
        line, fmt::format("{}.{}: '{}' is no name; expected letters, digits "
                          "and _, no digit first",
                          table, name, name));
  }
}

/// Parameters in the file's order; toml++ sorts by name. What an override put
/// there keeps its place: the key's.
std::vector<std::pair<std::string, const toml::node*>> in_file_order(
    const toml::table* parameters) {
  std::vector<std::pair<toml::source_position, std::string>> order;
  for (const auto& [key, node] : *parameters) {
    order.emplace_back(key.source().begin, key.str());
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<std::string, const toml::node*>> found;
  found.reserve(order.size());
  for (const auto& [position, name] : order) {
    found.emplace_back(name, parameters->get(name));
  }
  return found;
}

/// All names that expressions know: design variables, then parameters.
void claim_names(CaseContext& context, const std::vector<CaseTable>& design,
                 const toml::table* parameters, case_data::Case& result) {
  std::map<std::string, case_data::SourceLine> seen;
  const auto claim = [&](const std::string& name, case_data::SourceLine line) {
    if (is_reserved_name(name)) {
      context.problems.add(line,
                           fmt::format("'{}' is a name that expressions know "
                                       "already; choose another",
                                       name));
    } else if (!seen.emplace(name, line).second) {
      context.problems.add(
          line, fmt::format("'{}' is both a parameter and a design variable "
                            "(line {}); rename one",
                            name, seen[name]));
    }
    context.names.push_back(name);
  };
  for (const CaseTable& table : design) {
    claim(table.name(), table.line());
    result.design.push_back({.name = table.name(), .line = table.line()});
  }
  if (parameters != nullptr) {
    for (const auto& [name, node] : in_file_order(parameters)) {
      check_name(context, name, "parameters", context.line_of(*node));
      claim(name, context.line_of(*node));
    }
  }
  context.used.assign(context.names.size(), 0);
}

/// Values of the parameters that no design variable moves.
void find_constants(CaseContext& context, const case_data::Case& result) {
  context.constants.assign(context.names.size(), std::nullopt);
  const std::size_t first = context.names.size() - result.parameters.size();
  for (const int k : result.parameter_order) {
    const Expression& expression =
        result.parameters[static_cast<std::size_t>(k)].value.expression;
    std::vector<double> values(context.names.size(), 0.0);
    bool constant = true;
    for (const int name : expression.names_used()) {
      const auto& value = context.constants[static_cast<std::size_t>(name)];
      constant = constant && value.has_value();
      values[static_cast<std::size_t>(name)] = value.value_or(0.0);
    }
    if (constant) {
      try {
        context.constants[first + static_cast<std::size_t>(k)] =
            expression.evaluate(values);
      } catch (const ExpressionError&) {
        continue;  // told when the case's numbers are checked
      }
    }
  }
}

/// A name without a unit may stand for anything.
Measure of_a_name(const Measure& measure) {
  return measure.is_known() ? measure : Measure{};
}

/// Dimensions of all names from those of the design variables; problems are
/// those of `context`.
void find_measures(CaseContext& context, case_data::Case& result) {
  const std::size_t first = result.design.size();
  context.measures.assign(context.names.size(), {});
  for (std::size_t k = 0; k < first; ++k) {
    context.measures[k] = of_a_name(result.design[k].measure);
  }
  for (const int k : result.parameter_order) {
    const auto i = static_cast<std::size_t>(k);
    case_data::Quantity& value = result.parameters[i].value;
    if (!value.expression.is_constant()) {
      value.measure = measure_of(context, value);
    }
    context.measures[first + i] = of_a_name(value.measure);
  }
}

void read_parameters(CaseContext& context, const toml::table* parameters,
                     case_data::Case& result) {
  if (parameters != nullptr) {
    for (const auto& [name, node] : in_file_order(parameters)) {
      const case_data::Quantity zero{.line = context.line_of(*node),
                                     .key = "parameters." + name};
      result.parameters.push_back(
          {name, read_quantity(context, *node, std::nullopt, zero.key)
                     .value_or(zero)});
    }
  }
  case_data::order_parameters(result, context.problems);
  find_constants(context, result);
  // For the numbers of design variables, which know no other of them; what does
  // not fit is told once these are known too.
  case_data::CaseProblems later(result.path, result.overrides);
  CaseContext silent{.problems = later,
                     .overridden = context.overridden,
                     .names = context.names};
  find_measures(silent, result);
  context.measures = std::move(silent.measures);
}

/// What the initial value or a bound says; notes where they differ.
Measure measure_of_variable(CaseContext& context, const CaseTable& table,
                            const std::optional<Constant>& initial,
                            const std::vector<Constant>& bounds) {
  Measure found = initial ? initial->measure : Measure{};
  const char* from = "initial";
  for (const Constant& bound : bounds) {
    if (!bound.measure.is_known()) {
      continue;
    }
    if (found.is_known() && !(found.powers == bound.measure.powers)) {
      context.problems.add(
          table.line("bounds"),
          fmt::format("{}.bounds: {:g} is {}, and {} {}; a variable and its "
                      "bounds are of one dimension",
                      table.path(), bound.value,
                      described(bound.measure.powers), from,
                      described(found.powers)));
      return {};
    }
    if (!found.is_known()) {
      found = bound.measure;
      from = "the other bound";
    }
  }
  return found;
}

void read_design(const std::vector<CaseTable>& tables, CaseContext& context,
                 case_data::Case& result) {
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const CaseTable& table = tables[k];
    case_data::DesignVariable& variable = result.design[k];
    const auto initial = table.measured("initial");
    const std::vector<Constant> bounds = table.measured_constants("bounds");
    variable.initial = initial.value_or(Constant{}).value;
    variable.measure = measure_of_variable(context, table, initial, bounds);
    if (bounds.size() == 2) {
      variable.lower = bounds[0].value;
      variable.upper = bounds[1].value;
      if (!(variable.lower <= variable.upper)) {
        context.problems.add(
            table.line("bounds"),
            fmt::format("{}.bounds are [{:g}, {:g}]; the first must not be "
                        "above the second",
                        table.path(), variable.lower, variable.upper));
      } else if (initial && (variable.initial < variable.lower ||
                             variable.initial > variable.upper)) {
        context.problems.add(
            table.line("initial"),
            fmt::format("{}.initial is {:g}, outside its bounds [{:g}, {:g}]",
                        table.path(), variable.initial, variable.lower,
                        variable.upper));
      }
    }
  }
}

/// How far rims of facets may lie off their curves, where it is not said.
void set_within(case_data::Case& result) {
  constexpr double kUsual = 0.25;  // of resolution.fea
  for (case_data::FilmEntry& film : result.films) {
    if (!(film.spec.within > 0.0)) {
      film.spec.within = kUsual * result.resolution.fea;
    }
  }
  for (case_data::CapEntry& cap : result.caps) {
    if (!(cap.spec.within > 0.0)) {
      cap.spec.within = kUsual * result.resolution.fea;
    }
  }
}

void read_resolution(CaseContext& context, const toml::table& root,
                     case_data::Case& result) {
  const auto table = single_table(context, root, "resolution");
  if (!table) {
    return;
  }
  const auto refuse = [&](const char* key, double edge) {
    context.problems.add(
        table->line(key),
        fmt::format("resolution.{} is {:g}; an edge length is above 0", key,
                    edge));
  };
  case_data::Resolution& resolution = result.resolution;
  const auto length = [&](const char* key, double otherwise) {
    const double edge = table->constant(key).value_or(otherwise);
    if (table->has(key) && !(edge > 0.0)) {
      refuse(key, edge);
    }
    return edge;
  };
  resolution.keep_facets = table->flag("keep_facets").value_or(false);
  if (resolution.keep_facets && !case_data::has_facets(result)) {
    context.problems.add(table->line("keep_facets"),
                         "resolution.keep_facets: no film is of kind facets or "
                         "file; take it out");
  }
  const std::size_t before = context.problems.size();
  resolution.fea = length("fea", 0.0);
  resolution.film = length("film", resolution.fea / 2.0);
  for (const double edge : table->constants("export")) {
    if (!(edge > 0.0)) {
      refuse("export", edge);
    }
    resolution.export_edges.push_back(edge);
  }
  if (context.problems.size() == before && table->has("fea")) {
    case_data::nest_film(resolution, table->line("film"), context.problems);
  }
  set_within(result);
}

void read_process(CaseContext& context, const toml::table& root,
                  case_data::Case& result) {
  const auto table = single_table(context, root, "process");
  if (!table) {
    return;
  }
  result.process.name = table->text("name").value_or("");
  const double least = table->constant("smallest_feature").value_or(0.0);
  if (table->has("smallest_feature") && !(least > 0.0)) {
    context.problems.add(
        table->line("smallest_feature"),
        fmt::format("process.smallest_feature is {:g}; it is a length above 0",
                    least));
  }
  result.process.smallest_feature = least;
}

void read_symmetry(CaseContext& context, const toml::table& root,
                   case_data::Case& result) {
  const auto table = single_table(context, root, "symmetry");
  if (!table) {
    return;
  }
  for (const CaseTable& plane : table->tables("planes", "plane")) {
    const auto at = plane.constant_vector("at");
    const auto normal = plane.constant_vector("normal");
    if (normal && !(normal->norm() > 0.0)) {
      context.problems.add(plane.line("normal"),
                           "symmetry.planes: normal is 0; expected a direction "
                           "across the plane, away from what is drawn");
    } else if (at && normal) {
      result.symmetry.push_back({*at, normal->normalized(), plane.line()});
    }
  }
  case_data::check_planes(result, context.problems);
}

/// Does some text of the node's entries match? Of tables only what stands under
/// a key for quantities, unless `within` one.
bool has_quantity(const toml::node& node, const std::regex& pattern,
                  bool within) {
  static const std::set<std::string_view> kQuantities = {
      "min", "max", "targets", "tolerance", "deviations", "members"};
  if (const auto* table = node.as_table()) {
    return std::any_of(table->begin(), table->end(), [&](const auto& entry) {
      return has_quantity(entry.second, pattern,
                          within || kQuantities.count(entry.first.str()) > 0);
    });
  }
  if (const auto* array = node.as_array()) {
    return std::any_of(array->begin(), array->end(), [&](const auto& entry) {
      return has_quantity(entry, pattern, within);
    });
  }
  const auto* text = node.as_string();
  return within && text != nullptr && std::regex_search(text->get(), pattern);
}

/// Studies of one kind leave the keys of others unread: what stands there is
/// used, and so may be what follows a mistake.
void warn_of_unused(CaseContext& context, const toml::table& root,
                    const case_data::Case& result) {
  if (!context.problems.empty()) {
    return;
  }
  const toml::node* study = root.get("study");
  const auto in_study = [&](const std::string& name) {
    return study != nullptr &&
           has_quantity(*study, std::regex("\\b" + name + "\\b"), false);
  };
  for (std::size_t k = 0; k < context.names.size(); ++k) {
    const bool is_design = k < result.design.size();
    if (context.used[k] == 0 && !in_study(context.names[k])) {
      context.problems.warn(
          is_design ? result.design[k].line
                    : result.parameters[k - result.design.size()].value.line,
          fmt::format("{} '{}' is not used",
                      is_design ? "design variable" : "parameter",
                      context.names[k]));
    }
  }
}

}  // namespace

std::vector<CaseTable> named_tables(CaseContext& context,
                                    const toml::table& root,
                                    const char* table) {
  std::vector<CaseTable> found;
  const toml::node* node = root.get(table);
  if (node == nullptr) {
    return found;
  }
  const toml::table* all = node->as_table();
  if (all == nullptr) {
    context.problems.add(context.line_of(*node),
                         fmt::format("{} is {}; expected tables [{}.NAME]",
                                     table, described(*node), table));
    return found;
  }
  std::set<std::string> made;
  for (const auto& [key, entry] : *all) {
    const std::string name(key.str());
    const std::string path = fmt::format("{}.{}", table, name);
    check_name(context, name, table, context.line_of(entry));
    if (const toml::table* inner = entry.as_table()) {
      const CaseTable whole(context, *inner, case_table(table), name, path);
      for (CaseTable& copy : whole.copies()) {
        if (!made.insert(copy.name()).second ||
            (copy.name() != name && all->contains(copy.name()))) {
          context.problems.add(whole.line("repeat"),
                               fmt::format("{} makes '{}', which is there "
                                           "already; rename one",
                                           path, copy.name()));
        }
        found.push_back(std::move(copy));
      }
    } else {
      context.problems.add(context.line_of(entry),
                           fmt::format("{} is {}; expected a table [{}]", path,
                                       described(entry), path));
    }
  }
  // toml++ sorts by name; people see, and models follow, the file's order.
  std::stable_sort(found.begin(), found.end(),
                   [](const CaseTable& a, const CaseTable& b) {
                     return a.line() < b.line();
                   });
  return found;
}

std::optional<CaseTable> single_table(CaseContext& context,
                                      const toml::table& root,
                                      const char* table) {
  const toml::node* node = root.get(table);
  if (node == nullptr) {
    return std::nullopt;
  }
  if (const toml::table* found = node->as_table()) {
    return CaseTable(context, *found, case_table(table), "", table);
  }
  context.problems.add(context.line_of(*node),
                       fmt::format("{} is {}; expected a table [{}]", table,
                                   described(*node), table));
  return std::nullopt;
}

void read_tables(const toml::table& root, const OverriddenNodes& overridden,
                 case_data::CaseProblems& problems, case_data::Case& result) {
  CaseContext context{.problems = problems, .overridden = overridden};
  check_top(context, root);
  read_head(context, root, result);
  const toml::node* node = root.get("parameters");
  const toml::table* parameters = node == nullptr ? nullptr : node->as_table();
  if (node != nullptr && parameters == nullptr) {
    problems.add(context.line_of(*node),
                 fmt::format("parameters is {}; expected a table [parameters] "
                             "with name = value",
                             described(*node)));
  }
  const std::vector<CaseTable> design = named_tables(context, root, "design");
  claim_names(context, design, parameters, result);
  read_parameters(context, parameters, result);
  read_design(design, context, result);
  find_measures(context, result);
  read_symmetry(context, root, result);
  read_geometry(context, root, result);
  read_walls(context, root, result);
  read_fillets(context, root, result);
  read_fields(context, root, result);
  read_spines(context, root, result);
  read_resolution(context, root, result);
  read_process(context, root, result);
  read_analysis(context, root, result);
  case_data::apply_symmetry(result, context.problems);
  warn_of_unused(context, root, result);
}

}  // namespace meniscus::reader
