#include "pipeline/store/stored_case.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/files/named_values.h"
#include "pipeline/reader/case_reader.h"
#include "pipeline/store/find_runs.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/store/refreeze.h"

namespace meniscus::store {

std::string stored_case(const case_data::Case& input) {
  nlohmann::ordered_json stored = {{"path", input.path},
                                   {"overrides", input.overrides},
                                   {"text", input.text}};
  for (const case_data::CaseFile& file : input.files) {
    stored["files"].push_back({{"path", file.path}, {"text", file.text}});
  }
  return json_line(stored);
}

case_data::Case restore_case(const StudyMeta& meta) {
  const auto stored = parse_json(meta.case_text);
  if (!stored.is_object() || !stored.contains("text")) {
    throw IoError("the study holds no case that can be read; run it again");
  }
  std::vector<case_data::CaseFile> files;
  if (stored.contains("files")) {
    for (const auto& file : stored["files"]) {
      files.push_back({file["path"], file["text"]});
    }
  }
  reader::CaseReading reading = reader::read_case_text(
      stored["text"], stored["path"],
      stored["overrides"].get<std::vector<std::string>>(), std::move(files));
  if (!reading.input) {
    throw IoError("the study's case cannot be read by this version: " +
                  reading.problems.front());
  }
  return *std::move(reading.input);
}

std::map<std::string, std::string> stored_units(
    const std::filesystem::path& folder) {
  std::map<std::string, std::string> units;
  try {
    const case_data::Case input =
        restore_case(StudyStore::read(runs_in(folder).front().string()).meta());
    for (std::size_t k = 0; k < input.responses.size(); ++k) {
      units[input.responses[k].name] =
          case_data::response_unit(input, static_cast<int>(k));
    }
    if (input.study.objective && !input.study.fit) {
      units.emplace("objective",
                    case_data::response_unit(input, *input.study.objective));
    }
    for (const case_data::DesignVariable& variable : input.design) {
      units[variable.name] = case_data::unit_of(input.units, variable.measure);
    }
    for (const case_data::Parameter& parameter : input.parameters) {
      units[parameter.name] =
          case_data::unit_of(input.units, parameter.value.measure);
    }
  } catch (const Error&) {
    units.clear();  // of another version, or not begun: tables go without
  }
  return units;
}

const EvaluationRecord& best_record(
    const case_data::Case& input,
    const std::vector<EvaluationRecord>& records) {
  return best_record(input, records, answering_model(records));
}

const EvaluationRecord& best_record(
    const case_data::Case& input, const std::vector<EvaluationRecord>& records,
    const std::string& model) {
  const EvaluationRecord* best =
      input.study.objective ? best_by_objective(input.study, records, model)
                            : nullptr;
  if (best != nullptr) {
    return *best;
  }
  for (const EvaluationRecord& record : records) {
    if (record.failure || record.model != model) {
      continue;
    }
    const bool better =
        best == nullptr ||
        (input.study.kind == case_data::StudyKind::Match && record.mismatch &&
         (!best->mismatch || *record.mismatch < *best->mismatch));
    best = better ? &record : best;
  }
  if (best == nullptr) {
    throw InvalidInput(
        "the study has no design that could be evaluated; nothing to export");
  }
  return *best;
}

namespace {

/// The design that result.json tells. Throws InvalidInput where it tells none.
VectorX told_design(const case_data::Case& input,
                    const std::filesystem::path& file) {
  const auto result = parse_json(read_file(file));
  VectorX design = case_data::initial_design(input);
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    const std::string& name = input.design[k].name;
    const auto all =
        result.is_object() ? result.find("parameters") : result.end();
    const nlohmann::ordered_json* told =
        all == result.end() ? nullptr : files::find_named(*all, name);
    if (told == nullptr || !told->is_number()) {
      throw InvalidInput(fmt::format(
          "{}: it is damaged: no number for '{}' among its parameters; remove "
          "it to have the best design of study.sqlite, or run the case again",
          file.string(), name));
    }
    design[static_cast<Eigen::Index>(k)] = told->get<double>();
  }
  return design;
}

}  // namespace

VectorX answer_of_run(const case_data::Case& input,
                      const std::vector<EvaluationRecord>& records,
                      const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "result.json")) {
    const VectorX design = told_design(input, folder / "result.json");
    for (const EvaluationRecord& record : records) {
      if (!record.failure && record.inputs.size() == design.size() &&
          record.inputs == design) {
        return design;
      }
    }
  }
  return best_record(input, records).inputs;
}

namespace {

/// Has the case that variable, or a vector of that name and shape?
bool has_row(const case_data::Case& input, const case_data::DesignRow& row) {
  const std::vector<case_data::DesignRow> rows = case_data::design_rows(input);
  return std::any_of(rows.begin(), rows.end(), [&](const auto& other) {
    return other.label() == row.label();
  });
}

}  // namespace

std::vector<std::string> answer_as_overrides(
    const std::filesystem::path& folder, const case_data::Case& input) {
  const StudyStore store = StudyStore::read(folder.string());
  const case_data::Case run = restore_case(store.meta());
  if (run.units.length != input.units.length ||
      run.units.force != input.units.force) {
    throw InvalidInput(
        fmt::format("the run in '{}' is in {} and {}, the case in {} and {}",
                    folder.string(), run.units.length, run.units.force,
                    input.units.length, input.units.force));
  }
  const VectorX answer = answer_of_run(run, store.all(), folder);
  const nlohmann::ordered_json told =
      files::named_json(case_data::design_names(run), answer);
  std::vector<std::string> overrides;
  for (const case_data::DesignRow& row : case_data::design_rows(run)) {
    if (has_row(input, row)) {
      overrides.push_back(
          fmt::format("{}={}", row.name, json_text(told[row.name], -1)));
    }
  }
  const std::vector<std::string> names = case_data::row_names(input);
  if (overrides.empty()) {
    throw InvalidInput(fmt::format(
        "the run in '{}' has no design variable of this case, which has {}",
        folder.string(),
        names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
  }
  return overrides;
}

}  // namespace meniscus::store
