/// How far responses spread when the design scatters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "optimize/samples/spread.h"
#include "pipeline/case_data/case.h"

namespace meniscus::study {

struct ToleranceFigures {
  std::vector<int> responses;    // with exact derivatives: indices
  samples::LinearSpread linear;  // of those, a row each; see linear_spread()
  int samples = 0;               // evaluated to confirm it
  int failed = 0;                // of those
  /// Of all responses, in the case's order, where two samples answered.
  std::optional<samples::SampledSpread> sampled;
};

/// Sentences for responses whose sampled deviation is off the linear one by
/// more than the sample's own error: they are not linear over this scatter.
std::vector<std::string> tolerance_warnings(const case_data::Case& input,
                                            const ToleranceFigures& figures);

/// The part `tolerance` of result.json (docs/results.md).
nlohmann::ordered_json tolerance_json(const case_data::Case& input,
                                      const ToleranceFigures& figures);

/// A few lines per response for people.
std::string tolerance_text(const case_data::Case& input,
                           const ToleranceFigures& figures);

}  // namespace meniscus::study
