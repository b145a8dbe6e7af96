/// Responses that are made of others: expressions and envelopes.
#pragma once

#include <span>

#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// `above`: the values of the responses before it. Throws InvalidInput, naming
/// file, line and key, where an expression has no value.
double composed_value(const Case& input, const ResponseEntry& response,
                      const VectorX& design, std::span<const double> above);

/// Its derivative by one design variable; `rates`: of the responses above by
/// it. Throws likewise.
double composed_rate(const Case& input, const ResponseEntry& response,
                     const VectorX& design, int variable,
                     std::span<const double> above,
                     std::span<const double> rates);

/// The response that an envelope, of which `values` are all responses, has its
/// value from: the largest, or the least, the first of equals.
int extreme_part(const ResponseEntry& envelope, const VectorX& values);

}  // namespace meniscus::case_data
