/// What the readers of responses share. Part of the case-file reader.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "pipeline/case_data/case_kinds.h"
#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

/// The choices of keys, by kind of response.
const std::vector<case_data::Named<scan::ScanMeasure>>& scan_measures();
const std::vector<case_data::Named<case_data::StressMeasure>>&
stress_measures();
const std::vector<case_data::Named<case_data::FatigueCriterion>>&
fatigue_criteria();

/// The row that `key` names among those of its kind; the first without one.
template <class Value>
Value read_named(CaseContext& context, const CaseTable& table, const char* key,
                 const std::vector<case_data::Named<Value>>& rows) {
  const auto name = table.choice(key);
  const auto at = std::find_if(
      rows.begin(), rows.end(),
      [&](const case_data::Named<Value>& row) { return name == row.name; });
  if (at != rows.end()) {
    return at->value;
  }
  if (name) {
    context.problems.add(
        table.line(key),
        fmt::format("{}.{} is '{}'; of this kind it is one of {}", table.path(),
                    key, *name, case_data::choices_of(rows)));
  }
  return rows.front().value;
}

/// A constant above `above`; `standard` without the key or when it is wrong.
double constant_above(CaseContext& context, const CaseTable& table,
                      const char* key, double above, double standard);

/// What stress_ratio and fatigue are measured by; nothing of other kinds.
void read_strength(CaseContext& context, const CaseTable& table,
                   const case_data::Case& result,
                   case_data::ResponseEntry& response);

/// Adds `response` to the case; of an envelope, or of a kind asked of several
/// load cases, the responses that it is made of come before it, each by the
/// name NAME[LOAD CASE].
void add_response(CaseContext& context, const CaseTable& table,
                  case_data::ResponseEntry response, case_data::Case& result);

}  // namespace meniscus::reader
