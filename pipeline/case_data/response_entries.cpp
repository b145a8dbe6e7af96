#include "pipeline/case_data/response_entries.h"

#include <algorithm>

#include "core/error.h"
#include "pipeline/case_data/response_kinds.h"

namespace meniscus::case_data {

bool has_derivatives(const Case& input, int response) {
  const ResponseEntry& entry = input.responses[response];
  if (entry.kind != ResponseKind::Expression) {
    return row_of(entry.kind).has_derivatives;
  }
  const std::vector<int> used = entry.value.expression.names_used();
  const auto names =
      static_cast<int>(input.design.size() + input.parameters.size());
  return std::all_of(used.begin(), used.end(), [&](int name) {
    return name < names || has_derivatives(input, name - names);
  });
}

int response_index(const Case& input, const std::string& name) {
  int index = 0;
  while (input.responses[static_cast<std::size_t>(index)].name != name) {
    ++index;
  }
  return index;
}

}  // namespace meniscus::case_data
