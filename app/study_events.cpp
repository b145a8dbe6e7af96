#include "app/study_events.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/case_data/study_kinds.h"
#include "pipeline/files/named_values.h"
#include "pipeline/results/results.h"
#include "pipeline/study/study_records.h"

namespace meniscus::app {

namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json value_map(const std::vector<std::string>& names, const VectorX& values) {
  Json map = Json::object();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    map[names[static_cast<std::size_t>(k)]] = values[k];
  }
  return map;
}

const char* stage_name(const case_data::Case& input) {
  return case_data::row_of(input.study.kind).name;
}

Json best_json(const study::EvaluationEvent& event) {
  if (!event.best) {
    return {};
  }
  return {{"evaluation", event.best->evaluation},
          {"objective", or_null(event.best->objective)},
          {"violation", or_null(event.best->violation)}};
}

Json evaluation_json(const case_data::Case& input,
                     const study::EvaluationEvent& event) {
  const store::EvaluationRecord& record = *event.record;
  double seconds = 0.0;
  for (const auto& [stage, value] : record.seconds) {
    seconds += value;
  }
  Json json = {{"event", "evaluation"}, {"stage", stage_name(input)}};
  if (!event.member.empty()) {
    json["member"] = event.member;
  }
  json["model"] = record.model;
  json["phase"] = record.phase;
  json["evaluation"] = record.number;
  json["design"] = files::named_json(record.input_names, record.inputs);
  json["responses"] = value_map(record.response_names, record.responses);
  json["objective"] = or_null(event.status.objective);
  json["violation"] = or_null(event.status.violation);
  json["best"] = best_json(event);
  json["evaluation_seconds"] = seconds;
  json["evaluations"] = event.evaluations;
  json["failed"] = event.failed;
  json["planned"] = or_null(event.planned);
  json["left"] = or_null(event.left);
  json["failure"] = Json();
  if (record.failure) {
    json["failure"] = {{"kind", name_of(record.failure->kind)},
                       {"message", record.failure->message}};
  }
  return json;
}

/// "minimize: evaluation 12 of at most 300, mass = 12.3 kg, violation 0.02 of
/// 'sway', best so far mass = 12 kg (evaluation 9), at most 3 min left on this
/// model".
std::string status_text(const case_data::Case& input,
                        const study::EvaluationEvent& event) {
  std::string text =
      fmt::format("{}: evaluation {}", stage_name(input), event.evaluations);
  if (event.planned && *event.planned > 1) {
    text += fmt::format(" of at most {}", *event.planned);
  }
  if (event.status.objective) {
    const ShownUnit& shown = event.objective_shown;
    text += fmt::format(", {} = {}", event.objective_name,
                        shown.text(*event.status.objective));
  }
  const std::string progress = study::progress_text(event);
  return progress.empty() ? text : text + ", " + progress;
}

}  // namespace

MonitorEvent evaluation_event(const case_data::Case& input,
                              const study::EvaluationEvent& event) {
  const std::string member =
      event.member.empty() ? std::string() : event.member + ": ";
  const std::string progress = study::progress_text(event);
  return {.line = member + study::describe(input, *event.record) +
                  (progress.empty() ? "" : "; " + progress),
          // Members side by side have one line of status: the family's.
          .status = member.empty() ? status_text(input, event) : std::string(),
          .fields = evaluation_json(input, event)};
}

MonitorEvent end_event(study::RunStatus status, const std::string& message,
                       double seconds) {
  return {.line = {},
          .status = {},
          .fields = {{"event", "end"},
                     {"stage", "run"},
                     {"status", study::name_of(status)},
                     {"message", message},
                     {"total_seconds", seconds}}};
}

std::string outer_stage_of(const case_data::Case& input) {
  return case_data::row_of(input.study.kind).outer_stage;
}

}  // namespace meniscus::app
