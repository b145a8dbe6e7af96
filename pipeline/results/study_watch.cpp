#include "pipeline/results/study_watch.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/json.h"
#include "pipeline/files/text_table.h"
#include "pipeline/results/family_table.h"
#include "pipeline/results/results.h"
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
    const study::StudyNews& news) {
  if (!news.planned || records.empty()) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (const store::EvaluationRecord& record : records) {
    sum += seconds_of(record);
  }
  return sum / static_cast<double>(records.size()) *
         std::max(*news.planned - news.evaluations, 0);
}

std::string line_of(const case_data::Case& input,
                    const study::StudyNews& news) {
  const std::string standing = study::standing_text(news);
  return study::describe(input, *news.record) +
         (standing.empty() ? "" : "; " + standing);
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

void StudyWatch::look_at_study(StudyGlance& glance) {
  const store::StudyStore store = store::StudyStore::read(folder_.string());
  const case_data::Case input = store::restore_case(store.meta());
  const std::vector<store::EvaluationRecord> records = store.all();
  glance.title = input.title;
  glance.evaluations = static_cast<int>(records.size());
  if (records.empty()) {
    glance.text = "  no evaluation has ended yet\n";
    return;
  }
  study::StudyTeller teller(input, records.back().model);
  study::StudyNews news;
  for (const store::EvaluationRecord& record : records) {
    teller.remember(record);
    if (record.number > told_ && record.model == records.back().model) {
      glance.news.push_back(line_of(input, teller.news(record)));
    }
  }
  told_ = records.back().number;
  news = teller.news(records.back());
  news.left = glance.at_work ? time_left(records, news) : std::nullopt;
  glance.text = fmt::format(
      "  {} evaluations{}{}\n  {}\n", news.evaluations,
      news.planned && *news.planned > 1
          ? fmt::format(" of at most {}", *news.planned)
          : "",
      news.failed > 0 ? fmt::format(", {} failed", news.failed) : "",
      study::describe(input, records.back()));
  const std::string standing = study::standing_text(news);
  if (!standing.empty()) {
    glance.text += "  " + standing + "\n";
  }
}

void StudyWatch::look_at_family(StudyGlance& glance) {
  const std::string csv = read_file(folder_ / "family.csv");
  glance.family = true;
  glance.text = family_table_text(csv, store::stored_units(folder_));
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
        glance.news.push_back(fmt::format(
            "{}: {}{}", row.cells.front(), row.cells[1],
            row.cells.back().empty() ? "" : ": " + row.cells.back()));
      }
    }
  }
  for (std::size_t k = 1; k < names.size(); ++k) {
    const fs::path member = folder_ / "members" / names[k];
    if (glance.at_work && store::holder_of_run(member.string())) {
      StudyGlance inner;
      inner.at_work = true;
      try {
        StudyWatch(member).look_at_study(inner);
      } catch (const IoError&) {
        inner.text = "  begins\n";
      }
      glance.text += names[k] + "\n" + inner.text;
    }
  }
  rows_ = std::move(rows);
}

void StudyWatch::look_at_result(StudyGlance& glance) const {
  std::error_code code;
  if (!fs::exists(folder_ / "result.json", code)) {
    return;
  }
  const auto json = parse_json(read_file(folder_ / "result.json"));
  if (json.is_object()) {
    glance.status = json.value("status", "");
    glance.message = json.value("message", "");
    glance.title = json.value("case", "");
  }
}

StudyGlance StudyWatch::look() {
  StudyGlance glance;
  // The lock first: a run that ends meanwhile is looked at once more.
  if (const std::optional<std::string> holder =
          store::holder_of_run(folder_.string())) {
    glance.at_work = true;
    glance.holder = *holder;
  }
  try {
    std::error_code code;
    if (fs::exists(folder_ / "family.csv", code)) {
      look_at_family(glance);
    } else {
      look_at_study(glance);
    }
  } catch (const IoError&) {
    if (!glance.at_work) {
      throw;
    }
  }
  if (!glance.at_work) {
    look_at_result(glance);
  }
  return glance;
}

}  // namespace meniscus::results
