#include "pipeline/study/result_so_far.h"

#include "pipeline/store/refreeze.h"
#include "pipeline/store/stored_case.h"
#include "pipeline/study/study_records.h"

namespace meniscus {

RunResult result_so_far(const Case& input,
                        const std::vector<EvaluationRecord>& records) {
  RunResult result;
  for (const EvaluationRecord& record : records) {
    if (!is_study_model(record.model)) {
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
    result.best = to_evaluation(best_record(input, records));
  }
  return result;
}

}  // namespace meniscus
