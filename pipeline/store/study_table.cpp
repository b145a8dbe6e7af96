#include "pipeline/store/study_table.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "pipeline/files/text_table.h"

namespace meniscus::store {
namespace {

using Cells = std::vector<std::string>;

void add_new(const std::vector<std::string>& names, Cells& columns) {
  for (const std::string& name : names) {
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) {
      columns.push_back(name);
    }
  }
}

std::optional<double> value_of(const std::string& name,
                               const std::vector<std::string>& names,
                               const VectorX& values) {
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  return at < values.size() ? std::optional(values[at]) : std::nullopt;
}

// Head line and one line per record; `number` writes a double.
template <typename Number>
std::vector<Cells> table(const std::vector<EvaluationRecord>& records,
                         const Number& number) {
  Cells inputs;
  Cells responses;
  for (const EvaluationRecord& record : records) {
    add_new(record.input_names, inputs);
    add_new(record.response_names, responses);
  }
  const auto cell = [&number](const std::optional<double>& value) {
    return value ? number(*value) : std::string();
  };
  Cells head = {"evaluation"};
  head.insert(head.end(), inputs.begin(), inputs.end());
  head.insert(head.end(), responses.begin(), responses.end());
  for (const char* name : {"mismatch", "status", "seconds", "phase"}) {
    head.emplace_back(name);
  }
  std::vector<Cells> rows = {head};
  for (const EvaluationRecord& record : records) {
    Cells row = {std::to_string(record.number)};
    for (const std::string& name : inputs) {
      row.push_back(cell(value_of(name, record.input_names, record.inputs)));
    }
    for (const std::string& name : responses) {
      row.push_back(
          cell(value_of(name, record.response_names, record.responses)));
    }
    const double seconds = std::accumulate(
        record.seconds.begin(), record.seconds.end(), 0.0,
        [](double sum, const auto& stage) { return sum + stage.second; });
    row.push_back(cell(record.mismatch));
    row.emplace_back(record.failure ? name_of(record.failure->kind) : "ok");
    row.push_back(number(seconds));
    row.push_back(purpose_of(record));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string history_csv(const std::vector<EvaluationRecord>& records) {
  std::vector<Cells> rows =
      table(records, [](double value) { return fmt::format("{}", value); });
  rows[0].emplace_back("message");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::optional<Failure>& failure = records[i - 1].failure;
    rows[i].push_back(failure ? failure->message : "");
  }
  return files::csv_text(rows);
}

std::string study_table_text(const std::vector<EvaluationRecord>& records,
                             const std::map<std::string, std::string>& units) {
  std::vector<Cells> rows =
      table(records, [](double value) { return fmt::format("{:.6g}", value); });
  files::show_units(units, rows);
  files::join_elements(rows);
  std::string text = files::aligned_text(rows);
  for (const EvaluationRecord& record : records) {
    if (record.failure) {
      text += fmt::format("{}: {}\n", record.number, record.failure->message);
    }
  }
  return text;
}

}  // namespace meniscus::store
