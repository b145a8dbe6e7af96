/// What a study that did not end has come to.
#pragma once

#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"
#include "pipeline/study/study.h"

namespace meniscus::study {

/// What a run that ended early has come to: the incumbent and the counts.
RunResult result_so_far(const case_data::Case& input,
                        const std::vector<store::EvaluationRecord>& records);

}  // namespace meniscus::study
