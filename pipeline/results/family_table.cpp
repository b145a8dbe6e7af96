#include "pipeline/results/family_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/files/named_values.h"
#include "pipeline/files/text_table.h"
#include "pipeline/forward/figures_json.h"
#include "pipeline/results/results.h"

namespace meniscus::results {

namespace {

using Json = nlohmann::ordered_json;

double number(const Json& json) {
  return json.is_number() ? json.get<double>()
                          : std::numeric_limits<double>::quiet_NaN();
}

FamilyRow::Numbers numbers_of(const Json& result, const char* key,
                              const std::vector<std::string>& names) {
  FamilyRow::Numbers numbers;
  for (const std::string& name : names) {
    const Json* value =
        result.contains(key) ? files::find_named(result[key], name) : nullptr;
    if (value != nullptr) {
      numbers.emplace_back(name, number(*value));
    }
  }
  return numbers;
}

std::vector<std::string> names_of(const FamilyRow::Numbers& numbers) {
  std::vector<std::string> names;
  names.reserve(numbers.size());
  for (const auto& entry : numbers) {
    names.push_back(entry.first);
  }
  return names;
}

VectorX values_of(const FamilyRow::Numbers& numbers) {
  VectorX values(std::ssize(numbers));
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = numbers[k].second;
  }
  return values;
}

Json object(const FamilyRow::Numbers& numbers) {
  return files::named_json(names_of(numbers), values_of(numbers));
}

constexpr const char* kError = "_error";
constexpr const char* kAtBoundColumn = "at_bound";
constexpr const char* kMissedColumn = "missed";

void add_cells(const FamilyRow::Numbers& numbers,
               const std::vector<std::string>& columns, files::TextRow& cells) {
  for (const std::string& column : columns) {
    const auto at =
        std::find_if(numbers.begin(), numbers.end(),
                     [&](const auto& entry) { return entry.first == column; });
    cells.push_back(at == numbers.end() ? "" : fmt::format("{}", at->second));
  }
}

/// The longest list of names among the members.
std::vector<std::string> columns_of(const std::vector<FamilyRow>& rows,
                                    FamilyRow::Numbers FamilyRow::*numbers) {
  std::vector<std::string> columns;
  for (const FamilyRow& row : rows) {
    if ((row.*numbers).size() > columns.size()) {
      columns = names_of(row.*numbers);
    }
  }
  return columns;
}

/// `digits` of what is a number.
std::string shortened(const std::string& cell, int digits = 6) {
  double value = 0.0;
  const char* end = cell.data() + cell.size();
  const auto [at, error] = std::from_chars(cell.data(), end, value);
  return error == std::errc() && at == end
             ? fmt::format("{:.{}g}", value, digits)
             : cell;
}

/// Puts each NAME_error column, its unit in the head or not, beside NAME's.
void join_errors(std::vector<files::TextRow>& table) {
  for (std::size_t e = 0; !table.empty() && e < table[0].size();) {
    const std::size_t end = table[0][e].find(kError);
    const std::string name = table[0][e].substr(0, end);
    const auto of = std::find_if(
        table[0].begin(), table[0].end(), [&](const std::string& head) {
          return head == name || head.starts_with(name + " [");
        });
    if (end == std::string::npos || of == table[0].end()) {
      ++e;
      continue;
    }
    const auto value = static_cast<std::size_t>(of - table[0].begin());
    for (std::size_t r = 0; r < table.size(); ++r) {
      if (e >= table[r].size()) {
        continue;
      }
      if (r > 0 && !table[r][e].empty()) {
        table[r][value] += " +- " + shortened(table[r][e], 2);
      }
      table[r].erase(table[r].begin() + static_cast<std::ptrdiff_t>(e));
    }
  }
}

/// What no member has needs no column.
void drop_empty_columns(std::vector<files::TextRow>& table) {
  for (std::size_t k = 0; !table.empty() && k < table[0].size();) {
    const bool filled = std::any_of(
        table.begin() + 1, table.end(),
        [&](const auto& row) { return k < row.size() && !row[k].empty(); });
    if (filled ||
        (table[0][k] != kAtBoundColumn && table[0][k] != kMissedColumn)) {
      ++k;
      continue;
    }
    for (files::TextRow& row : table) {
      if (k < row.size()) {
        row.erase(row.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
  }
}

/// "foot (lower)", "t (3 lower)" of variables that stand at a bound.
void add_bounds(const case_data::Case& member,
                const case_data::DesignRow& variables, FamilyRow& row) {
  for (const std::string side : {"lower", "upper"}) {
    const std::size_t count =
        count_at_bound(member, variables, values_of(row.design), side);
    if (count > 0) {
      row.at_bound.push_back(
          variables.vector == nullptr
              ? fmt::format("{} ({})", variables.name, side)
              : fmt::format("{} ({} {})", variables.name, count, side));
    }
  }
}

std::vector<std::string> missed_by(const FamilyRow& row) {
  std::vector<std::string> missed;
  for (const study::Constraint& constraint : row.constraints) {
    if (!constraint.satisfied) {
      missed.push_back(constraint.name);
    }
  }
  return missed;
}

}  // namespace

FamilyRow family_row(const case_data::Case& member, const Json& result) {
  FamilyRow row;
  row.status = result.value("status", "error");
  row.message = result.value("message", "");
  std::vector<std::string> parameters;
  for (const case_data::Parameter& parameter : member.parameters) {
    parameters.push_back(parameter.name);
  }
  row.parameters = numbers_of(result, "parameters", parameters);
  row.responses =
      numbers_of(result, "responses", case_data::response_names(member));
  if (!row.responses.empty()) {
    row.design =
        numbers_of(result, "parameters", case_data::design_names(member));
  }
  for (const auto& error : numbers_of(result, "response_errors",
                                      case_data::response_names(member))) {
    if (std::isfinite(error.second)) {
      row.errors.push_back(error);
    }
  }
  if (row.design.size() == member.design.size()) {
    for (const case_data::DesignRow& variables :
         case_data::design_rows(member)) {
      add_bounds(member, variables, row);
    }
  }
  row.objective = number(result.value("objective", Json()));
  const Json constraints = result.value("constraints", Json::object());
  for (const auto& [name, c] : constraints.items()) {
    row.constraints.push_back({.name = name,
                               .value = number(c["value"]),
                               .bound = number(c["bound"]),
                               .satisfied = c["satisfied"] == true});
  }
  row.evaluations = result.value("evaluations", 0);
  row.seconds = number(result.value("seconds", Json::object())["total"]);
  return row;
}

std::string family_csv(const std::vector<FamilyRow>& rows) {
  const auto parameters = columns_of(rows, &FamilyRow::parameters);
  const auto design = columns_of(rows, &FamilyRow::design);
  const auto responses = columns_of(rows, &FamilyRow::responses);
  files::TextRow head = {"member", "status", "parent"};
  for (const auto* names : {&parameters, &design, &responses}) {
    head.insert(head.end(), names->begin(), names->end());
  }
  std::vector<std::string> errors;
  for (const std::string& name : responses) {
    if (std::any_of(rows.begin(), rows.end(), [&](const FamilyRow& row) {
          const auto of = names_of(row.errors);
          return std::find(of.begin(), of.end(), name) != of.end();
        })) {
      errors.push_back(name);
      head.push_back(name + kError);
    }
  }
  head.insert(head.end(), {"objective", "evaluations", "seconds",
                           kAtBoundColumn, kMissedColumn, "message"});
  std::vector<files::TextRow> table = {head};
  for (const FamilyRow& row : rows) {
    files::TextRow cells = {row.name, row.status, row.parent};
    add_cells(row.parameters, parameters, cells);
    add_cells(row.design, design, cells);
    add_cells(row.responses, responses, cells);
    add_cells(row.errors, errors, cells);
    cells.push_back(row.responses.empty() || std::isnan(row.objective)
                        ? ""
                        : fmt::format("{}", row.objective));
    cells.push_back(std::to_string(row.evaluations));
    cells.push_back(fmt::format("{:.3f}", row.seconds));
    cells.push_back(fmt::format("{}", fmt::join(row.at_bound, ", ")));
    cells.push_back(fmt::format("{}", fmt::join(missed_by(row), ", ")));
    cells.push_back(row.message);
    table.push_back(std::move(cells));
  }
  return files::csv_text(table);
}

std::string family_table_text(const std::string& csv,
                              const std::map<std::string, std::string>& units) {
  std::vector<files::TextRow> table;
  std::string messages;
  for (const files::CsvRow& row : files::parse_csv(csv).rows) {
    files::TextRow cells = row.cells;
    const std::string message = cells.back();
    cells.pop_back();
    if (!table.empty() && cells.size() > 1) {
      if (cells[1] != "converged" && !message.empty()) {
        messages += fmt::format("{}: {}\n", cells[0], message);
      }
      std::transform(cells.begin() + 1, cells.end(), cells.begin() + 1,
                     [](const std::string& cell) { return shortened(cell); });
    }
    table.push_back(std::move(cells));
  }
  std::map<std::string, std::string> with_errors = units;
  for (const auto& [name, unit] : units) {
    with_errors.emplace(name + kError, unit);
  }
  files::show_units(with_errors, table);
  files::join_elements(table);
  join_errors(table);
  drop_empty_columns(table);
  return table.empty() ? "" : files::aligned_text(table) + messages;
}

Json family_json(const case_data::Case& family, const FamilyResult& result,
                 const std::string& program_version) {
  Json json;
  json["schema_version"] = kResultSchemaVersion;
  json["case"] = family.title;
  json["case_hash"] = family.hash;
  json["program_version"] = program_version;
  json["units"] = forward::units_json(family.units);
  json["status"] = study::name_of(result.status);
  json["message"] = result.message;
  json["members"] = Json::array();
  for (const FamilyRow& row : result.rows) {
    Json entry = {{"name", row.name},
                  {"folder", row.folder},
                  {"parent", row.parent},
                  {"status", row.status},
                  {"message", row.message},
                  {"parameters", object(row.parameters)},
                  {"design", object(row.design)},
                  {"objective", row.objective},
                  {"constraints", Json::object()},
                  {"responses", object(row.responses)},
                  {"response_errors", object(row.errors)},
                  {"at_bound", row.at_bound},
                  {"evaluations", row.evaluations},
                  {"seconds", row.seconds}};
    for (const study::Constraint& c : row.constraints) {
      entry["constraints"][c.name] = {
          {"value", c.value}, {"bound", c.bound}, {"satisfied", c.satisfied}};
    }
    json["members"].push_back(std::move(entry));
  }
  json["seconds"] = {{"total", result.total_seconds}};
  json["warnings"] = result.warnings;
  return json;
}

void set_status(FamilyResult& result) {
  const auto sized =
      std::count_if(result.rows.begin(), result.rows.end(),
                    [](const FamilyRow& r) { return r.is_converged(); });
  const auto has = [&](const char* status) {
    return std::any_of(result.rows.begin(), result.rows.end(),
                       [&](const FamilyRow& r) { return r.status == status; });
  };
  const bool all = sized == std::ssize(result.rows);
  result.status = all                  ? study::RunStatus::Converged
                  : has("interrupted") ? study::RunStatus::Interrupted
                  : has("stopped") || has("waiting")
                      ? study::RunStatus::Stopped
                      : study::RunStatus::Infeasible;
  result.message =
      fmt::format("{} of {} members are sized", sized, result.rows.size());
  std::vector<std::string> others;
  for (const FamilyRow& row : result.rows) {
    if (!row.is_converged()) {
      others.push_back(fmt::format("{} ({})", row.name, row.status));
    }
  }
  if (!others.empty()) {
    result.message += fmt::format("; not {}", fmt::join(others, ", "));
  }
}

}  // namespace meniscus::results
