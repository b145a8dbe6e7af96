#include "pipeline/case_data/response_entries.h"

#include <algorithm>

#include "core/error.h"
#include "pipeline/case_data/response_kinds.h"

namespace meniscus::case_data {

bool is_composed(const ResponseEntry& entry) {
  return entry.kind == ResponseKind::Expression ||
         entry.kind == ResponseKind::Envelope;
}

std::vector<int> responses_in(const Case& input, const ResponseEntry& entry) {
  if (entry.kind != ResponseKind::Expression) {
    return entry.parts;
  }
  const auto names =
      static_cast<int>(input.design.size() + input.parameters.size());
  std::vector<int> responses;
  for (const int name : entry.value.expression.names_used()) {
    if (name >= names) {
      responses.push_back(name - names);
    }
  }
  return responses;
}

bool has_derivatives(const Case& input, int response) {
  const ResponseEntry& entry = input.responses[response];
  if (!is_composed(entry)) {
    return row_of(entry.kind).has_derivatives;
  }
  const std::vector<int> used = responses_in(input, entry);
  return std::all_of(used.begin(), used.end(),
                     [&](int other) { return has_derivatives(input, other); });
}

bool is_extreme(const Case& input, int response) {
  const ResponseEntry& entry = input.responses[response];
  if (!is_composed(entry)) {
    return row_of(entry.kind).is_extreme;
  }
  const std::vector<int> used = responses_in(input, entry);
  return std::any_of(used.begin(), used.end(),
                     [&](int other) { return is_extreme(input, other); });
}

bool knows_worst_direction(const ResponseEntry& entry) {
  const WorstKnown worst = row_of(entry.kind).worst;
  return worst != WorstKnown::No && (worst != WorstKnown::AtNodes ||
                                     entry.stress == StressMeasure::VonMises);
}

std::vector<DirectionsEntry>::const_iterator directions_with(
    const Case& input, std::size_t load_case) {
  return std::find_if(input.directions.begin(), input.directions.end(),
                      [&](const DirectionsEntry& load) {
                        const auto first = static_cast<std::size_t>(load.first);
                        return load_case >= first && load_case < first + 3;
                      });
}

std::size_t shown_load_case(const Case& input, const ResponseEntry& entry) {
  if (!entry.worst_in) {
    return static_cast<std::size_t>(entry.load_case);
  }
  const auto of =
      directions_with(input, static_cast<std::size_t>(entry.load_case));
  return input.load_cases.size() +
         static_cast<std::size_t>(of - input.directions.begin());
}

int response_index(const Case& input, const std::string& name) {
  int index = 0;
  while (input.responses[static_cast<std::size_t>(index)].name != name) {
    ++index;
  }
  return index;
}

}  // namespace meniscus::case_data
