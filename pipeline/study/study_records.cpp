#include "pipeline/study/study_records.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/count_text.h"
#include "pipeline/forward/figures_json.h"
#include "core/json.h"

namespace meniscus {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

EvaluationRecord make_record(const Case& input, const Evaluation& evaluation) {
  EvaluationRecord record;
  record.input_names = design_names(input);
  record.inputs = evaluation.design;
  record.response_names = response_names(input);
  record.responses = evaluation.responses;
  record.failure = evaluation.failure;
  record.figures = json_text(Json{{"film", film_json(evaluation.film)},
                        {"tet", tet_json(evaluation.tet)},
                        {"fea", fea_json(evaluation.fea)}}, -1);
  record.seconds = {{"evolve", evaluation.seconds.film},
                    {"mesh", evaluation.seconds.mesh},
                    {"fea", evaluation.seconds.fea}};
  return record;
}

Evaluation to_evaluation(const EvaluationRecord& record) {
  Evaluation evaluation;
  evaluation.design = record.inputs;
  evaluation.responses = record.responses;
  evaluation.failure = record.failure;
  return evaluation;
}

std::string describe(const Case& input, const EvaluationRecord& record) {
  std::string text =
      fmt::format("evaluation {} ({}):", record.number, purpose_of(record));
  for (Eigen::Index k = 0; k < record.inputs.size(); ++k) {
    text += fmt::format(" {} = {}", record.input_names[k],
                        quantity_text(record.inputs[k], ""));
  }
  if (record.failure) {
    return text + "; cannot evaluate here: " + record.failure->message;
  }
  for (Eigen::Index k = 0; k < record.responses.size(); ++k) {
    text +=
        fmt::format("{} {} = {}", k == 0 ? ";" : ",", record.response_names[k],
                    quantity_text(record.responses[k],
                                  response_unit(input, static_cast<int>(k))));
  }
  if (record.mismatch) {
    text += fmt::format("; mismatch {:.3g}", *record.mismatch);
  }
  return text;
}

}  // namespace meniscus
