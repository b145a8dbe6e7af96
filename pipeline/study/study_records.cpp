#include "pipeline/study/study_records.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/count_text.h"
#include "core/json.h"
#include "pipeline/forward/figures_json.h"

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

store::EvaluationRecord make_record(const case_data::Case& input,
                                    const forward::Evaluation& evaluation) {
  store::EvaluationRecord record;
  record.input_names = case_data::design_names(input);
  record.inputs = evaluation.design;
  record.response_names = case_data::response_names(input);
  record.responses = evaluation.responses;
  record.failure = evaluation.failure;
  record.figures = json_text(Json{{"film", forward::film_json(evaluation.film)},
                                  {"tet", forward::tet_json(evaluation.tet)},
                                  {"fea", forward::fea_json(evaluation.fea)}},
                             -1);
  record.seconds = {{"evolve", evaluation.seconds.film},
                    {"mesh", evaluation.seconds.mesh},
                    {"fea", evaluation.seconds.fea}};
  return record;
}

forward::Evaluation to_evaluation(const store::EvaluationRecord& record) {
  forward::Evaluation evaluation;
  evaluation.design = record.inputs;
  evaluation.responses = record.responses;
  evaluation.failure = record.failure;
  return evaluation;
}

std::string describe(const case_data::Case& input,
                     const store::EvaluationRecord& record) {
  std::string text = fmt::format("evaluation {} ({}):", record.number,
                                 store::purpose_of(record));
  for (Eigen::Index k = 0; k < record.inputs.size(); ++k) {
    text += fmt::format(" {} = {}", record.input_names[k],
                        quantity_text(record.inputs[k], ""));
  }
  if (record.failure) {
    return text + "; cannot evaluate here: " + record.failure->message;
  }
  for (Eigen::Index k = 0; k < record.responses.size(); ++k) {
    const ShownUnit unit = case_data::shown_unit(input, static_cast<int>(k));
    text += fmt::format(
        "{} {} = {}", k == 0 ? ";" : ",", record.response_names[k],
        quantity_text(unit.factor * record.responses[k], unit.unit));
  }
  if (record.mismatch) {
    text += fmt::format("; mismatch {:.3g}", *record.mismatch);
  }
  return text;
}

}  // namespace meniscus::study
