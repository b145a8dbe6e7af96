/// A study as text: the table of `study show` and history.csv.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/store/study_store.h"

namespace meniscus::store {

/// RFC 4180 with a head line: evaluation, each design variable, each response,
/// mismatch, status ("ok" or the failure's kind), seconds, phase, message.
/// Numbers with as many digits as bring the same double back, decimal point
/// whatever the locale; empty where there is none. Lines end with \n.
std::string history_csv(const std::vector<EvaluationRecord>& records);

/// Aligned columns for people, six digits; failures explained below. `units`,
/// by name of a response, go into the head line.
std::string study_table_text(
    const std::vector<EvaluationRecord>& records,
    const std::map<std::string, std::string>& units = {});

}  // namespace meniscus::store
