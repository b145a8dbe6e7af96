/// Evaluations as the database keeps them, and a line for people.
#pragma once

#include <string>

#include "pipeline/case_data/case.h"
#include "pipeline/forward/forward_model.h"
#include "pipeline/store/study_store.h"

namespace meniscus::study {

store::EvaluationRecord make_record(const case_data::Case& input,
                                    const forward::Evaluation& evaluation);

/// Inputs, responses and failure of a record; the figures stay in its text.
forward::Evaluation to_evaluation(const store::EvaluationRecord& record);

/// One line: "evaluation 3 (step): support_x = 12.3; left_deflection = ...".
/// More than six variables are left out; of more than six responses six are
/// there, what the study asks for before others. The database has all.
std::string describe(const case_data::Case& input,
                     const store::EvaluationRecord& record);

}  // namespace meniscus::study
