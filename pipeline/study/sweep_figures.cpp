#include "pipeline/study/sweep_figures.h"

#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/files/named_values.h"
#include "pipeline/responses/responses.h"

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

void widen(ResponseRange& range, double value, const VectorX& design,
           bool first) {
  if (first || value < range.least) {
    range.least = value;
    range.least_at = design;
  }
  if (first || value > range.largest) {
    range.largest = value;
    range.largest_at = design;
  }
  range.mean += value;
}

}  // namespace

SweepFigures sweep_figures(
    int designs, const std::vector<store::EvaluationRecord>& records) {
  SweepFigures figures{.designs = designs,
                       .looked_at = static_cast<int>(records.size())};
  std::map<std::string, int> failures;
  int answered = 0;
  for (const store::EvaluationRecord& record : records) {
    if (record.failure) {
      ++figures.failed;
      ++failures[name_of(record.failure->kind)];
      continue;
    }
    figures.responses.resize(record.response_names.size());
    for (std::size_t k = 0; k < figures.responses.size(); ++k) {
      widen(figures.responses[k],
            record.responses[static_cast<Eigen::Index>(k)], record.inputs,
            answered == 0);
    }
    ++answered;
  }
  for (ResponseRange& range : figures.responses) {
    range.mean /= answered;
  }
  figures.failures.assign(failures.begin(), failures.end());
  return figures;
}

nlohmann::ordered_json sweep_json(const case_data::Case& input,
                                  const SweepFigures& figures) {
  Json json = {{"method", input.study.method},
               {"designs", figures.designs},
               {"looked_at", figures.looked_at},
               {"failed", figures.failed}};
  json["failures"] = Json::object();
  for (const auto& [kind, count] : figures.failures) {
    json["failures"][kind] = count;
  }
  json["responses"] = Json::object();
  const std::vector<std::string> names = case_data::design_names(input);
  for (std::size_t k = 0; k < figures.responses.size(); ++k) {
    const ResponseRange& range = figures.responses[k];
    json["responses"][input.responses[k].name] = {
        {"least", range.least},
        {"least_at", files::named_json(names, range.least_at)},
        {"largest", range.largest},
        {"largest_at", files::named_json(names, range.largest_at)},
        {"mean", range.mean}};
  }
  return json;
}

std::string sweep_text(const case_data::Case& input,
                       const SweepFigures& figures) {
  std::string text = fmt::format("  sweep of {} designs", figures.designs);
  if (figures.looked_at < figures.designs) {
    text += fmt::format(", {} looked at", figures.looked_at);
  }
  for (std::size_t k = 0; k < figures.failures.size(); ++k) {
    text += fmt::format("{} {} {}", k == 0 ? ", without answer:" : ",",
                        figures.failures[k].second, figures.failures[k].first);
  }
  text += "\n";
  for (std::size_t k = 0; k < figures.responses.size(); ++k) {
    const ResponseRange& range = figures.responses[k];
    const ShownUnit shown = case_data::shown_unit(input, static_cast<int>(k));
    text += fmt::format(
        "  {:<20} mean {}\n"
        "  {:<20} least {} at {}\n"
        "  {:<20} largest {} at {}\n",
        input.responses[k].name, shown.text(range.mean), "",
        shown.text(range.least), case_data::design_text(input, range.least_at),
        "", shown.text(range.largest),
        case_data::design_text(input, range.largest_at));
  }
  return text;
}

}  // namespace meniscus::study
