#include "pipeline/study/sweep_figures.h"

#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/forward/responses.h"

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

Json place_json(const case_data::Case& input, const VectorX& design) {
  Json json = Json::object();
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    json[input.design[k].name] = design[static_cast<Eigen::Index>(k)];
  }
  return json;
}

std::string place_text(const case_data::Case& input, const VectorX& design) {
  std::string text;
  for (std::size_t k = 0; k < input.design.size(); ++k) {
    text +=
        fmt::format("{}{} = {:.6g}", k == 0 ? "" : ", ", input.design[k].name,
                    design[static_cast<Eigen::Index>(k)]);
  }
  return text;
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
  for (std::size_t k = 0; k < figures.responses.size(); ++k) {
    const ResponseRange& range = figures.responses[k];
    json["responses"][input.responses[k].name] = {
        {"least", range.least},
        {"least_at", place_json(input, range.least_at)},
        {"largest", range.largest},
        {"largest_at", place_json(input, range.largest_at)},
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
    auto [factor, unit] = case_data::shown_unit(input, static_cast<int>(k));
    unit.insert(0, unit.empty() ? "" : " ");
    text += fmt::format(
        "  {:<20} mean {:.6g}{}\n"
        "  {:<20} least {:.6g}{} at {}\n"
        "  {:<20} largest {:.6g}{} at {}\n",
        input.responses[k].name, factor * range.mean, unit, "",
        factor * range.least, unit, place_text(input, range.least_at), "",
        factor * range.largest, unit, place_text(input, range.largest_at));
  }
  return text;
}

}  // namespace meniscus::study
