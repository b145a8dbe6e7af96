#include "pipeline/store/study_rows.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/json.h"
#include "pipeline/files/content_hash.h"

namespace meniscus::store {

const char* const kEvaluationTable = R"(
CREATE TABLE evaluation (
  number INTEGER PRIMARY KEY, key BLOB NOT NULL, model TEXT NOT NULL,
  phase TEXT NOT NULL, input_names TEXT NOT NULL, inputs BLOB NOT NULL,
  response_names TEXT NOT NULL, responses BLOB NOT NULL, gradient BLOB,
  mismatch REAL, failure TEXT, failure_message TEXT, figures TEXT NOT NULL,
  seconds TEXT NOT NULL, seal TEXT NOT NULL);
CREATE INDEX evaluation_key ON evaluation (key);
)";

namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little,
              "doubles are stored in the machine's own order");

constexpr const char* kColumns =
    "number, key, model, phase, input_names, inputs, response_names, "
    "responses, gradient, mismatch, failure, failure_message, figures, "
    "seconds, seal";

/// The columns as they stand in the database.
struct Row {
  std::string key, model, phase, input_names, inputs, response_names, responses,
      gradient;
  std::optional<double> mismatch;
  std::optional<std::string> failure, failure_message;
  std::string figures, seconds;
};

std::string to_bytes(const double* data, Eigen::Index size) {
  std::string bytes(static_cast<std::size_t>(size) * sizeof(double), '\0');
  if (size > 0) {
    std::memcpy(bytes.data(), data, bytes.size());
  }
  return bytes;
}

VectorX to_vector(const std::string& bytes) {
  VectorX values(static_cast<Eigen::Index>(bytes.size() / sizeof(double)));
  if (values.size() > 0) {
    std::memcpy(values.data(), bytes.data(),
                static_cast<std::size_t>(values.size()) * sizeof(double));
  }
  return values;
}

std::string to_text(const Json& value) { return json_line(value); }

std::string checksum_of(const Row& row) {
  const std::string mismatch =
      row.mismatch ? to_bytes(&*row.mismatch, 1) : std::string();
  return meniscus::store::checksum_of(
      {row.key, row.model, row.phase, row.input_names, row.inputs,
       row.response_names, row.responses, row.gradient, mismatch,
       row.failure.value_or("-"), row.failure_message.value_or("-"),
       row.figures, row.seconds});
}

Row to_row(const std::string& case_hash, const EvaluationRecord& record) {
  Row row;
  row.key = key_of(case_hash, record.model, record.inputs);
  row.model = record.model;
  row.phase = record.phase;
  row.input_names = to_text(record.input_names);
  row.inputs = to_bytes(record.inputs.data(), record.inputs.size());
  row.response_names = to_text(record.response_names);
  row.responses = to_bytes(record.responses.data(), record.responses.size());
  row.gradient = to_bytes(record.gradient.data(), record.gradient.size());
  row.mismatch = record.mismatch;
  if (record.failure) {
    row.failure = name_of(record.failure->kind);
    row.failure_message = record.failure->message;
  }
  row.figures = record.figures;
  Json seconds = Json::object();
  for (const auto& [stage, value] : record.seconds) {
    seconds[stage] = value;
  }
  row.seconds = to_text(seconds);
  return row;
}

/// Of a statement that stands on kColumns. Throws IoError where what it says is
/// not what was written.
Row read_row(const SqliteDatabase& database, SqliteStatement& from) {
  Row row;
  row.key = from.bytes(1);
  row.model = from.bytes(2);
  row.phase = from.bytes(3);
  row.input_names = from.bytes(4);
  row.inputs = from.bytes(5);
  row.response_names = from.bytes(6);
  row.responses = from.bytes(7);
  row.gradient = from.bytes(8);
  if (!from.is_null(9)) {
    row.mismatch = from.number(9);
  }
  if (!from.is_null(10)) {
    row.failure = from.bytes(10);
    row.failure_message = from.bytes(11);
  }
  row.figures = from.bytes(12);
  row.seconds = from.bytes(13);
  if (from.bytes(14) != checksum_of(row)) {
    database.fail_damaged(fmt::format(
        "what evaluation {} says is not what was written", from.integer(0)));
  }
  return row;
}

EvaluationRecord to_record(int number, const Row& row) {
  EvaluationRecord record;
  record.number = number;
  record.model = row.model;
  record.phase = row.phase;
  record.input_names = require_json(row.input_names);
  record.inputs = to_vector(row.inputs);
  record.response_names = require_json(row.response_names);
  record.responses = to_vector(row.responses);
  const VectorX gradient = to_vector(row.gradient);
  if (gradient.size() > 0 && record.inputs.size() > 0) {
    record.gradient = gradient.reshaped(gradient.size() / record.inputs.size(),
                                        record.inputs.size());
  }
  record.mismatch = row.mismatch;
  if (row.failure) {
    record.failure = Failure{failure_kind_of(*row.failure),
                             row.failure_message.value_or("")};
  }
  record.figures = row.figures;
  const Json seconds = require_json(row.seconds);
  for (const auto& [stage, value] : seconds.items()) {
    record.seconds.emplace_back(stage,
                                value.is_number() ? value.get<double>() : 0.0);
  }
  return record;
}

void check_record(const EvaluationRecord& record) {
  const auto inputs = static_cast<Eigen::Index>(record.input_names.size());
  const auto responses =
      static_cast<Eigen::Index>(record.response_names.size());
  const bool fits =
      record.inputs.size() == inputs &&
      (record.responses.size() == responses ||
       (record.failure && record.responses.size() == 0)) &&
      (record.gradient.size() == 0 || (record.gradient.rows() == responses &&
                                       record.gradient.cols() == inputs));
  if (!fits) {
    throw InvalidInput(fmt::format(
        "study: a record of {} inputs with {} names, {} responses with {} "
        "names and a {} x {} gradient does not fit together",
        record.inputs.size(), inputs, record.responses.size(), responses,
        record.gradient.rows(), record.gradient.cols()));
  }
}

void bind_or_null(SqliteStatement& statement,
                  const std::optional<std::string>& text) {
  if (text) {
    statement.bind(*text);
  } else {
    statement.bind_null();
  }
}

}  // namespace

std::string checksum_of(std::initializer_list<std::string_view> parts) {
  std::string all;
  for (const std::string_view part : parts) {
    all += fmt::format("{}:", part.size());
    all += part;
  }
  return files::content_hash(all);
}

std::string key_of(const std::string& case_hash, const std::string& model,
                   const VectorX& inputs) {
  // + 0 turns -0 into 0: one design, one key.
  const VectorX point = (inputs.array() + 0.0).matrix();
  return case_hash + '\0' + model + '\0' + to_bytes(point.data(), point.size());
}

int insert_row(const SqliteDatabase& database, const std::string& case_hash,
               const EvaluationRecord& record) {
  check_record(record);
  const Row row = to_row(case_hash, record);
  SqliteStatement into(database,
                       "INSERT INTO evaluation VALUES "
                       "(NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  into.bind_bytes(row.key);
  into.bind(row.model);
  into.bind(row.phase);
  into.bind(row.input_names);
  into.bind_bytes(row.inputs);
  into.bind(row.response_names);
  into.bind_bytes(row.responses);
  into.bind_bytes(row.gradient);
  into.bind(row.mismatch);
  bind_or_null(into, row.failure);
  bind_or_null(into, row.failure_message);
  into.bind(row.figures);
  into.bind(row.seconds);
  into.bind(checksum_of(row));
  into.step();
  return database.last_row();
}

void replace_gradient(const SqliteDatabase& database, int number,
                      const Eigen::MatrixXd& gradient) {
  Row row;
  {
    SqliteStatement found(
        database,
        fmt::format("SELECT {} FROM evaluation WHERE number = ?", kColumns));
    found.bind(number);
    if (!found.step()) {
      throw InvalidInput(fmt::format("study: there is no record {}", number));
    }
    row = read_row(database, found);
  }
  EvaluationRecord record = to_record(number, row);
  record.gradient = gradient;
  check_record(record);
  row.gradient = to_bytes(gradient.data(), gradient.size());
  SqliteStatement into(
      database,
      "UPDATE evaluation SET gradient = ?, seal = ? WHERE number = ?");
  into.bind_bytes(row.gradient);
  into.bind(checksum_of(row));
  into.bind(number);
  into.step();
}

std::vector<EvaluationRecord> select_rows(const SqliteDatabase& database,
                                          const std::string& condition,
                                          const std::string& key) {
  SqliteStatement found(
      database, fmt::format("SELECT {} FROM evaluation {} ORDER BY number",
                            kColumns, condition));
  if (!key.empty()) {
    found.bind_bytes(key);
  }
  std::vector<EvaluationRecord> records;
  while (found.step()) {
    records.push_back(to_record(found.integer(0), read_row(database, found)));
  }
  return records;
}

}  // namespace meniscus::store
