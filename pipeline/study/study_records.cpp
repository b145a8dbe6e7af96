#include "pipeline/study/study_records.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/json.h"
#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_data/studied_responses.h"
#include "pipeline/forward/figures_json.h"

namespace meniscus::study {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostNamed = 6;  // in a line that a person reads

/// Indices of all responses; of more than kMostNamed what the study asks for
/// before others.
std::vector<int> named_responses(const case_data::Case& input, int count) {
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  if (count <= kMostNamed) {
    return all;
  }
  std::vector<int> candidates = case_data::studied_responses(input);
  candidates.insert(candidates.end(), all.begin(), all.end());
  std::vector<int> named;
  for (const int response : candidates) {
    if (static_cast<int>(named.size()) < kMostNamed &&
        std::find(named.begin(), named.end(), response) == named.end()) {
      named.push_back(response);
    }
  }
  return named;
}

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
  const std::vector<case_data::DesignRow> rows = case_data::design_rows(input);
  if (std::ssize(rows) <= kMostNamed) {
    for (const case_data::DesignRow& row : rows) {
      text += fmt::format(" {} = {}", row.name,
                          case_data::row_text(input, row, record.inputs));
    }
    text += rows.empty() ? "" : ";";
  }
  if (record.failure) {
    return text + " cannot evaluate here: " + record.failure->message;
  }
  const char* between = " ";
  for (const int k :
       named_responses(input, static_cast<int>(record.responses.size()))) {
    const ShownUnit unit = case_data::shown_unit(input, k);
    text += fmt::format("{}{} = {}", between, record.response_names[k],
                        unit.text(record.responses[k]));
    between = ", ";
  }
  if (record.mismatch) {
    text += fmt::format("; mismatch {:.3g}", *record.mismatch);
  }
  return text;
}

}  // namespace meniscus::study
