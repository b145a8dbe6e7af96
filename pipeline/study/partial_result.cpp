#include "pipeline/study/partial_result.h"

#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/study_records.h"

namespace meniscus::study {

RunResult result_so_far(const case_data::Case& input,
                        const std::vector<store::EvaluationRecord>& records) {
  RunResult result;
  for (const store::EvaluationRecord& record : records) {
    if (!store::is_study_model(record.model)) {
      continue;
    }
    if (++result.evaluations == 1) {
      result.start = to_evaluation(record);
    }
    result.failed_evaluations += record.failure ? 1 : 0;
  }
  if (result.failed_evaluations == result.evaluations) {
    result.start.reset();
  } else {
    result.best = to_evaluation(store::best_record(input, records));
  }
  return result;
}

}  // namespace meniscus::study
