#include "pipeline/case_data/studied_responses.h"

#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/study_kinds.h"

namespace meniscus::case_data {

std::vector<int> studied_responses(const Case& input) {
  const auto responses = row_of(input.study.kind).responses;
  return responses == nullptr ? std::vector<int>() : responses(input);
}

bool asks_for_gradients(const StudyEntry& study) {
  const auto gradients = row_of(study.kind).gradients;
  return gradients != nullptr && gradients(study);
}

}  // namespace meniscus::case_data
