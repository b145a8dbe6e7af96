#include "pipeline/results/study_watch.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/json.h"
#include "pipeline/files/text_table.h"
#include "pipeline/results/family_table.h"
#include "pipeline/results/results.h"
#include "pipeline/store/refreeze.h"
#include "pipeline/store/run_lock.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/study_records.h"

namespace meniscus::results {

namespace {

namespace fs = std::filesystem;

double seconds_of(const store::EvaluationRecord& record) {
  return std::accumulate(
      record.seconds.begin(), record.seconds.end(), 0.0,
      [](double sum, const auto& stage) { return sum + stage.second; });
}

/// From the seconds that evaluations took: who watches has no clock of the run.
std::optional<double> time_left(
    const std::vector<store::EvaluationRecord>& records,
    const study::EvaluationEvent& event) {
  if (!event.planned || records.empty()) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (const store::EvaluationRecord& record : records) {
    sum += seconds_of(record);
  }
  return sum / static_cast<double>(records.size()) *
         std::max(*event.planned - event.evaluations, 0);
}

std::string line_of(const case_data::Case& input,
                    const study::EvaluationEvent& event) {
  const std::string progress = study::progress_text(event);
  return study::describe(input, *event.record) +
         (progress.empty() ? "" : "; " + progress);
}

}  // namespace

StudyWatch::StudyWatch(fs::path folder) : folder_(std::move(folder)) {
  std::error_code code;
  const auto has = [&](const char* name) {
    return fs::exists(folder_ / name, code);
  };
  if (!has("study.sqlite") && !has("family.csv") &&
      !store::holder_of_run(folder_.string())) {
    throw IoError(fmt::format(
        "no run in '{}': neither study.sqlite nor family.csv is there; give "
        "the results folder of a run",
        folder_.string()));
  }
}

void StudyWatch::poll_study(StudyStatus& status) {
  const store::StudyStore store = store::StudyStore::read(folder_.string());
  const case_data::Case input = store::restore_case(store.meta());
  const std::vector<store::EvaluationRecord> records = store.all();
  status.title = input.title;
  status.evaluations = static_cast<int>(records.size());
  if (records.empty()) {
    status.text = "  no evaluation has ended yet\n";
    return;
  }
  // What is the best so far is so on its own model; evaluations of the study's
  // own models are counted together.
  std::map<std::string, study::ProgressTracker> trackers;
  int evaluations = 0;
  int failed = 0;
  study::EvaluationEvent event;
  for (const store::EvaluationRecord& record : records) {
    study::ProgressTracker& tracker =
        trackers.try_emplace(record.model, input, record.model).first->second;
    tracker.add(record);
    event = tracker.event(record);
    if (store::is_study_model(record.model)) {
      event.evaluations = ++evaluations;
      event.failed = failed += record.failure ? 1 : 0;
    }
    if (record.number > last_seen_) {
      status.new_lines.push_back(line_of(input, event));
    }
  }
  last_seen_ = records.back().number;
  event.left = status.at_work ? time_left(records, event) : std::nullopt;
  status.text = fmt::format(
      "  {} evaluations{}{}\n  {}\n", event.evaluations,
      event.planned && *event.planned > 1
          ? fmt::format(" of at most {}", *event.planned)
          : "",
      event.failed > 0 ? fmt::format(", {} failed", event.failed) : "",
      study::describe(input, records.back()));
  const std::string progress = study::progress_text(event);
  if (!progress.empty()) {
    status.text += "  " + progress + "\n";
  }
}

void StudyWatch::poll_family(StudyStatus& status) {
  const std::string csv = read_file(folder_ / "family.csv");
  status.family = true;
  status.text = family_table_text(csv, store::stored_units(folder_));
  std::vector<std::string> rows;
  std::vector<std::string> names;
  for (const files::CsvRow& row : files::parse_csv(csv).rows) {
    rows.push_back(files::csv_text({row.cells}));
    names.push_back(row.cells.front());
    if (rows.size() == 1 || row.cells.size() < 2) {
      continue;  // the head line
    }
    const std::size_t k = rows.size() - 1;
    if (k >= rows_.size() || rows_[k] != rows[k]) {
      if (row.cells[1] != "waiting") {
        status.new_lines.push_back(fmt::format(
            "{}: {}{}", row.cells.front(), row.cells[1],
            row.cells.back().empty() ? "" : ": " + row.cells.back()));
      }
    }
  }
  for (std::size_t k = 1; k < names.size(); ++k) {
    const fs::path member = folder_ / "members" / names[k];
    if (status.at_work && store::holder_of_run(member.string())) {
      StudyStatus inner;
      inner.at_work = true;
      try {
        StudyWatch(member).poll_study(inner);
      } catch (const IoError&) {
        inner.text = "  begins\n";
      }
      status.text += names[k] + "\n" + inner.text;
    }
  }
  rows_ = std::move(rows);
}

void StudyWatch::poll_result(StudyStatus& status) const {
  std::error_code code;
  if (!fs::exists(folder_ / "result.json", code)) {
    return;
  }
  const auto json = parse_json(read_file(folder_ / "result.json"));
  if (json.is_object()) {
    status.status = json.value("status", "");
    status.message = json.value("message", "");
    status.title = json.value("case", "");
  }
}

StudyStatus StudyWatch::poll() {
  StudyStatus status;
  // The lock first: a run that ends meanwhile is looked at once more.
  if (const std::optional<std::string> holder =
          store::holder_of_run(folder_.string())) {
    status.at_work = true;
    status.holder = *holder;
  }
  try {
    std::error_code code;
    if (fs::exists(folder_ / "family.csv", code)) {
      poll_family(status);
    } else {
      poll_study(status);
    }
  } catch (const IoError&) {
    if (!status.at_work) {
      throw;
    }
  }
  if (!status.at_work) {
    poll_result(status);
  }
  return status;
}

}  // namespace meniscus::results
