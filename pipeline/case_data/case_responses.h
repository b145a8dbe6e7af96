/// From a case's responses to their numbers at one design. Part of evaluate().
#pragma once

#include "pipeline/case_data/case.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

/// Values, or rates. Its fields throw InvalidInput, naming file, line and key,
/// at a place where they have no value. What is wrong elsewhere is told in the
/// problems of `values`.
ResponseInputs response_of(const Case& input, const ResponseEntry& response,
                           const CaseValues& values);

}  // namespace meniscus::case_data
