/// Design variables, vectors of them and parameters: the names that expressions
/// know. Part of the case-file reader.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "pipeline/case_data/case_checks.h"
#include "pipeline/files/earlier_run.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

constexpr std::size_t kMostIndices = 3;  // i, j, k

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

/// What the case holds of that run, from its results folder at first: beside
/// the case, else in the working folder. Throws Error.
std::string earlier_run_text(const std::string& folder,
                             case_data::Case& result) {
  namespace fs = std::filesystem;
  const std::string path = (fs::path(folder) / "result.json").string();
  if (const case_data::CaseFile* held = held_file(result, path)) {
    return held->text;
  }
  const fs::path beside = fs::path(result.path).parent_path() / path;
  const fs::path found = fs::is_regular_file(beside) ? beside : fs::path(path);
  if (!fs::is_regular_file(found)) {
    throw InvalidInput(
        "there is no result.json in this folder, looked for beside the case "
        "and in the working folder; expected the results of a run");
  }
  result.files.push_back({path, files::earlier_run_text(read_file(found))});
  return result.files.back().text;
}

}  // namespace

std::vector<int> read_shape(CaseContext& context, const CaseTable& table,
                            const char* key) {
  if (!table.has(key)) {
    return {};
  }
  const toml::node& node = *table.node(key);
  const toml::array* array = node.as_array();
  const std::size_t wanted = array == nullptr ? 1 : array->size();
  std::vector<int> shape;
  double elements = 1.0;
  for (std::size_t k = 0; k < wanted; ++k) {
    const toml::node& item = array == nullptr ? node : (*array)[k];
    const auto count = item.value_exact<std::int64_t>();
    if (!count || *count < 1 || *count > kMostElements) {
      break;
    }
    shape.push_back(static_cast<int>(*count));
    elements *= static_cast<double>(*count);
  }
  if (shape.empty() || shape.size() != wanted || wanted > kMostIndices) {
    context.problems.add(
        table.line(key),
        fmt::format("{}.{} is {}; expected one to three whole numbers, each 1 "
                    "or more: 12 or [8, 4]",
                    table.path(), key, described(node)));
    return {};
  }
  if (elements > kMostElements) {
    context.problems.add(
        table.line(key),
        fmt::format("{}.{} makes {:.0f} {}; at most {} are taken", table.path(),
                    key, elements,
                    std::string_view(key) == "shape" ? "design variables"
                                                     : "coefficients",
                    kMostElements));
    return {};
  }
  return shape;
}

namespace {

/// The design variables of one table: one, or all elements of a vector.
void add_variables(CaseContext& context, const CaseTable& table,
                   case_data::Case& result) {
  const std::vector<int> shape = read_shape(context, table, "shape");
  if (shape.empty()) {
    result.design.push_back({.name = table.name(), .line = table.line()});
    return;
  }
  result.vectors.push_back({.name = table.name(),
                            .shape = shape,
                            .first = result.design.size(),
                            .line = table.line()});
  std::vector<int> at(shape.size(), 1);
  for (bool more = true; more;) {
    result.design.push_back(
        {.name = element_name(table.name(), at), .line = table.line()});
    more = false;
    for (std::size_t k = at.size(); k-- > 0 && !more;) {
      more = at[k] < shape[k];
      at[k] = more ? at[k] + 1 : 1;
    }
  }
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
  };
  for (const CaseTable& table : design) {
    claim(table.name(), table.line());
    add_variables(context, table, result);
  }
  for (const case_data::DesignVariable& variable : result.design) {
    context.names.push_back(variable.name);
  }
  if (parameters != nullptr) {
    for (const auto& [name, node] : in_file_order(parameters)) {
      check_name(context, name, "parameters", context.line_of(*node));
      claim(name, context.line_of(*node));
      context.names.push_back(name);
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
  // Indices of vectors in parameters know those that are numbers; all others
  // have no value before all are read.
  context.constants.assign(context.names.size(), std::nullopt);
  std::size_t next = result.design.size();
  if (parameters != nullptr) {
    for (const auto& [name, node] : in_file_order(parameters)) {
      if (node->is_number()) {
        context.constants[next] = node->value<double>();
      }
      ++next;
    }
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

/// A constant of the file and its line.
struct Given {
  Constant constant;
  case_data::SourceLine line = 0;
};

/// "one value for all, or 8 arrays of 12".
std::string wanted_elements(std::span<const int> shape) {
  return fmt::format(
      "one value for all, or {} {}", shape.front(),
      shape.size() == 1 ? "values"
      : shape.size() == 2
          ? fmt::format("arrays of {}", shape[1])
          : fmt::format("arrays of {} arrays of {}", shape[1], shape[2]));
}

/// Nested arrays of that shape, one below the other. False with a problem
/// noted.
bool read_nested(CaseContext& context, const toml::node& node,
                 const std::string& key, std::span<const int> shape,
                 std::size_t level, std::vector<Given>& result) {
  if (level == shape.size()) {
    const auto found = read_measured(context, node, std::nullopt, key);
    if (found) {
      result.push_back({*found, context.line_of(node)});
    }
    return found.has_value();
  }
  const toml::array* array = node.as_array();
  if (array == nullptr ||
      std::ssize(*array) != static_cast<std::ptrdiff_t>(shape[level])) {
    context.problems.add(
        context.line_of(node),
        fmt::format("{} has {} where {} values are wanted: its shape is {}; "
                    "expected {}",
                    key, described(node), shape[level], shape_text(shape),
                    wanted_elements(shape)));
    return false;
  }
  return std::all_of(array->begin(), array->end(), [&](const auto& item) {
    return read_nested(context, item, key, shape, level + 1, result);
  });
}

/// One per element, the last index running fastest, of a variable without
/// shape one; empty with a problem noted.
std::vector<Given> read_elements(CaseContext& context, const toml::node& node,
                                 const std::string& key,
                                 std::span<const int> shape) {
  std::size_t count = 1;
  for (const int along : shape) {
    count *= static_cast<std::size_t>(along);
  }
  const bool for_all = !node.is_array();
  std::vector<Given> result;
  if (!read_nested(context, node, key, shape, for_all ? shape.size() : 0,
                   result)) {
    return {};
  }
  if (for_all) {
    result.resize(count, result.front());
  }
  return result;
}

/// Lower and upper bounds; empty with a problem noted.
std::array<std::vector<Given>, 2> read_bounds(CaseContext& context,
                                              const CaseTable& table,
                                              std::span<const int> shape) {
  const toml::node* node = table.node("bounds");
  const toml::array* pair = node == nullptr ? nullptr : node->as_array();
  const std::string key = table.path() + ".bounds";
  if (node != nullptr && (pair == nullptr || pair->size() != 2)) {
    context.problems.add(
        table.line("bounds"),
        fmt::format("{} is {}; expected two numbers: [least, largest]{}", key,
                    described(*node),
                    shape.empty() ? "" : ", each " + wanted_elements(shape)));
    return {};
  }
  std::array<std::vector<Given>, 2> result;
  for (std::size_t k = 0; pair != nullptr && k < 2; ++k) {
    result[k] = read_elements(context, (*pair)[k], key, shape);
  }
  return result;
}

/// What the initial values or bounds say; notes where they differ.
Measure measure_of_variables(CaseContext& context, const CaseTable& table,
                             const std::vector<Given>& initial,
                             const std::array<std::vector<Given>, 2>& bounds) {
  Measure found;
  const char* from = "";
  const auto look = [&](const std::vector<Given>& all, const char* key,
                        const char* name) {
    for (const auto& [constant, line] : all) {
      const Measure& measure = constant.measure;
      if (measure.is_known() && found.is_known() &&
          !(found.powers == measure.powers)) {
        context.problems.add(
            line,
            fmt::format("{}.{}: {:g} is {}, and {} {}; a variable and its "
                        "bounds are of one dimension",
                        table.path(), key, constant.value,
                        described(measure.powers), from,
                        described(found.powers)));
        return false;
      }
      if (measure.is_known() && !found.is_known()) {
        found = measure;
        from = name;
      }
    }
    return true;
  };
  const bool alike = look(initial, "initial", "initial") &&
                     look(bounds[0], "bounds", "the other bound") &&
                     look(bounds[1], "bounds", "the other bound");
  return alike ? found : Measure{};
}

/// Notes bounds that are none, and an initial value beyond them.
bool check_bounds(CaseContext& context, const CaseTable& table,
                  const case_data::DesignVariable& variable,
                  case_data::SourceLine bounds_line, const Given* initial) {
  if (!(variable.lower <= variable.upper)) {
    context.problems.add(
        bounds_line,
        fmt::format("design.{}.bounds are [{:g}, {:g}]; the first must not be "
                    "above the second",
                    variable.name, variable.lower, variable.upper));
    return false;
  }
  if (initial != nullptr && (variable.initial < variable.lower ||
                             variable.initial > variable.upper)) {
    context.problems.add(
        initial->line == 0 ? table.line("initial") : initial->line,
        fmt::format("design.{}.initial is {:g}, outside its bounds [{:g}, "
                    "{:g}]",
                    variable.name, variable.initial, variable.lower,
                    variable.upper));
    return false;
  }
  return true;
}

/// The values of one table's variables; of what is wrong with each element the
/// first is told.
void read_variables(CaseContext& context, const CaseTable& table,
                    std::span<const int> shape,
                    std::span<case_data::DesignVariable> variables) {
  const toml::node* node = table.node("initial");
  const std::string key = table.path() + ".initial";
  const std::vector<Given> initial =
      node == nullptr ? std::vector<Given>()
                      : read_elements(context, *node, key, shape);
  const std::array<std::vector<Given>, 2> bounds =
      read_bounds(context, table, shape);
  const Measure measure = measure_of_variables(context, table, initial, bounds);
  const bool bounded = !bounds[0].empty() && !bounds[1].empty();
  bool good = true;
  for (std::size_t k = 0; k < variables.size(); ++k) {
    case_data::DesignVariable& variable = variables[k];
    variable.measure = measure;
    variable.initial = initial.empty() ? 0.0 : initial[k].constant.value;
    if (bounded) {
      variable.lower = bounds[0][k].constant.value;
      variable.upper = bounds[1][k].constant.value;
      good =
          good && check_bounds(context, table, variable, table.line("bounds"),
                               initial.empty() ? nullptr : &initial[k]);
    }
  }
}

void read_design(const std::vector<CaseTable>& tables, CaseContext& context,
                 case_data::Case& result) {
  std::size_t at = 0;
  auto vector = result.vectors.begin();
  for (const CaseTable& table : tables) {
    const bool is_vector =
        vector != result.vectors.end() && vector->first == at;
    const std::vector<int> shape =
        is_vector ? vector->shape : std::vector<int>();
    const std::size_t count = is_vector ? vector->size() : 1;
    read_variables(context, table, shape,
                   std::span(result.design).subspan(at, count));
    at += count;
    vector += is_vector ? 1 : 0;
  }
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

/// "'t' is not used", or which elements of it are not.
std::string unused_text(const case_data::Case& input,
                        const case_data::DesignVector& vector,
                        const std::vector<char>& used) {
  constexpr std::size_t kMostNamed = 3;
  std::vector<std::string> unused;
  for (std::size_t k = vector.first; k < vector.first + vector.size(); ++k) {
    if (used[k] == 0) {
      unused.push_back(input.design[k].name);
    }
  }
  if (unused.empty() || unused.size() == vector.size()) {
    return unused.empty()
               ? ""
               : fmt::format("design variable '{}' is not used", vector.name);
  }
  const std::size_t count = unused.size();
  unused.resize(std::min(count, kMostNamed));
  return fmt::format(
      "design variable '{}': {} of its {} elements are not "
      "used, {}{}",
      vector.name, count, vector.size(), fmt::join(unused, ", "),
      count > kMostNamed ? ", ..." : "");
}

}  // namespace

void read_names(CaseContext& context, const toml::table& root,
                case_data::Case& result) {
  const toml::node* node = root.get("parameters");
  const toml::table* parameters = node == nullptr ? nullptr : node->as_table();
  if (node != nullptr && parameters == nullptr) {
    context.problems.add(
        context.line_of(*node),
        fmt::format("parameters is {}; expected a table [parameters] "
                    "with name = value",
                    described(*node)));
  }
  const std::vector<CaseTable> design = named_tables(context, root, "design");
  claim_names(context, design, parameters, result);
  read_parameters(context, parameters, result);
  read_design(design, context, result);
  find_measures(context, result);
}

void warn_of_unused(CaseContext& context, const toml::table& root,
                    const case_data::Case& result) {
  if (!context.problems.empty()) {
    return;
  }
  for (std::size_t s = 0; s < result.shapes.size(); ++s) {
    if (context.used_shapes.count(s) == 0) {
      context.problems.warn(
          result.shapes[s].line,
          fmt::format("shapes.{} is not used", result.shapes[s].name));
      continue;
    }
    for (const case_data::Quantity& c : result.shapes[s].coefficients) {
      for (const int name : c.expression.names_used()) {
        context.used[static_cast<std::size_t>(name)] = 1;
      }
    }
  }
  const toml::node* study = root.get("study");
  const auto in_study = [&](const std::string& name) {
    return study != nullptr &&
           has_quantity(*study, std::regex("\\b" + name + "\\b"), false);
  };
  auto vector = result.vectors.begin();
  for (std::size_t k = 0; k < context.names.size(); ++k) {
    if (vector != result.vectors.end() && vector->first == k) {
      const std::string text = unused_text(result, *vector, context.used);
      if (!text.empty() && !in_study(vector->name)) {
        context.problems.warn(vector->line, text);
      }
      k += vector->size() - 1;
      ++vector;
      continue;
    }
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

namespace {

/// The values of an earlier run, in order. Throws Error.
std::vector<VectorX> values_of_run(const CaseContext& context,
                                   const std::string& folder,
                                   case_data::Case& result) {
  files::EarlierRun run =
      files::read_earlier_run(earlier_run_text(folder, result), context.names);
  if (run.units != result.units.name) {
    throw InvalidInput(
        fmt::format("its numbers are in {}, those of this "
                    "case in {}",
                    run.units, result.units.name));
  }
  if (!std::any_of(run.values.back().begin(), run.values.back().end(),
                   [](double value) { return std::isfinite(value); })) {
    throw InvalidInput(
        "it has no design variable and no parameter of this case, by which "
        "films could be led from there");
  }
  return std::move(run.values);
}

/// What a name of a table `start` stands for.
struct Target {
  std::size_t first = 0;  // of the names
  std::size_t count = 1;
  std::span<const int> shape;
};

/// Null with a problem noted, also for a parameter that design variables move.
std::optional<Target> target_named(CaseContext& context,
                                   const std::string& name,
                                   case_data::SourceLine line,
                                   const case_data::Case& result) {
  std::vector<std::string> known;
  for (const case_data::DesignVector& vector : result.vectors) {
    if (vector.name == name) {
      return Target{vector.first, vector.size(), vector.shape};
    }
    known.push_back(vector.name);
  }
  const auto& names = context.names;
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) {
    std::copy_if(names.begin(), names.end(), std::back_inserter(known),
                 [](const std::string& text) {
                   return text.find('[') == std::string::npos;
                 });
    context.problems.add(
        line, fmt::format("start has '{}', which is no design variable and no "
                          "parameter{}",
                          name, case_data::advice(name, known)));
    return std::nullopt;
  }
  const auto k = static_cast<std::size_t>(at - names.begin());
  if (k >= result.design.size() && !context.constants[k]) {
    context.problems.add(
        line, fmt::format("start.{}: design variables move this parameter; "
                          "name them instead",
                          name));
    return std::nullopt;
  }
  return Target{.first = k};
}

/// One value per name, NaN where the table has none; problems are those of
/// `context`.
VectorX values_of_table(CaseContext& context, const toml::table& table,
                        const case_data::Case& result) {
  VectorX values = VectorX::Constant(std::ssize(context.names),
                                     std::numeric_limits<double>::quiet_NaN());
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    const std::optional<Target> target =
        target_named(context, name, context.line_of(node), result);
    if (!target) {
      continue;
    }
    const std::vector<Given> given =
        read_elements(context, node, "start." + name, target->shape);
    for (std::size_t k = 0; k < given.size(); ++k) {
      const Measure& measure = given[k].constant.measure;
      const Measure& wanted = context.measures[target->first + k];
      if (measure.is_known() && wanted.is_known() &&
          !(measure.powers == wanted.powers)) {
        context.problems.add(given[k].line,
                             fmt::format("start.{} is {}, and '{}' {}", name,
                                         described(measure.powers), name,
                                         described(wanted.powers)));
        break;
      }
      values[static_cast<Eigen::Index>(target->first + k)] =
          given[k].constant.value;
    }
  }
  return values;
}

}  // namespace

void read_start(CaseContext& context, const toml::table& root,
                case_data::Case& result) {
  const toml::node* node = root.get("start");
  if (node == nullptr) {
    return;
  }
  const case_data::SourceLine line = context.line_of(*node);
  if (const auto* folder = node->as_string()) {
    try {
      result.way = values_of_run(context, folder->get(), result);
    } catch (const Error& error) {
      context.problems.add(
          line, fmt::format("start = \"{}\": {}", folder->get(), error.what()));
    }
  } else if (const auto* table = node->as_table();
             table != nullptr && !table->empty()) {
    result.way = {values_of_table(context, *table, result)};
  } else {
    context.problems.add(
        line, fmt::format("start is {}; expected the results folder of an "
                          "earlier run in quotes, or values by name: "
                          "{{ width = 20 }}",
                          table == nullptr ? described(*node) : "empty"));
  }
  for (VectorX& values : result.way) {
    for (std::size_t k = 0; k < result.design.size(); ++k) {
      double& value = values[static_cast<Eigen::Index>(k)];
      value = std::isfinite(value) ? value : result.design[k].initial;
    }
  }
}

}  // namespace meniscus::reader
