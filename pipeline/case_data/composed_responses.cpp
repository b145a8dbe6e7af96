#include "pipeline/case_data/composed_responses.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/math/smooth_extreme.h"
#include "pipeline/case_data/case_values.h"

namespace meniscus::case_data {

namespace {

SmoothExtreme envelope_of(const ResponseEntry& response,
                          std::span<const double> above) {
  std::vector<double> values;
  values.reserve(response.parts.size());
  for (const int part : response.parts) {
    values.push_back(above[static_cast<std::size_t>(part)]);
  }
  return response.least ? smooth_minimum(values, response.excess)
                        : smooth_maximum(values, response.excess);
}

}  // namespace

double composed_value(const Case& input, const ResponseEntry& response,
                      const VectorX& design, std::span<const double> above) {
  if (response.kind == ResponseKind::Envelope) {
    return envelope_of(response, above).value;
  }
  std::vector<std::string> problems;
  const double value =
      CaseValues(input, design, problems).at(response.value, above);
  if (!problems.empty()) {
    throw InvalidInput(problems.front());
  }
  return value;
}

double composed_rate(const Case& input, const ResponseEntry& response,
                     const VectorX& design, int variable,
                     std::span<const double> above,
                     std::span<const double> rates) {
  if (response.kind == ResponseKind::Envelope) {
    const SmoothExtreme extreme = envelope_of(response, above);
    double rate = 0.0;
    for (std::size_t k = 0; k < response.parts.size(); ++k) {
      rate += extreme.by_number[k] *
              rates[static_cast<std::size_t>(response.parts[k])];
    }
    return rate;
  }
  std::vector<std::string> problems;
  const CaseValues values(input, design, problems, variable);
  const double rate = values.rate(response.value, above, rates);
  if (!problems.empty()) {
    throw InvalidInput(problems.front());
  }
  return rate;
}

int extreme_part(const ResponseEntry& envelope, const VectorX& values) {
  return *std::max_element(
      envelope.parts.begin(), envelope.parts.end(), [&](int a, int b) {
        return envelope.least ? values[a] > values[b] : values[a] < values[b];
      });
}

}  // namespace meniscus::case_data
