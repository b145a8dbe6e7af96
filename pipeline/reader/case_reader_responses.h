/// What the readers of responses share. Part of the case-file reader.
#pragma once

#include <algorithm>
#include <optional>
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

/// Its kind has the key `load_case`.
bool takes_load_case(const case_data::ResponseEntry& entry);

/// What a response may be of: a load case, or the worst direction of a load
/// from any, whose unit loads begin at `load_case`.
struct AskedCase {
  std::string name;
  int load_case = 0;
  std::optional<Cone> worst_in = {};
};

/// The first of them, or the one by that name, unit loads included; nothing
/// where there is none.
std::optional<AskedCase> asked_case(const case_data::Case& result,
                                    const std::optional<std::string>& name);

/// All, in order, without unit loads.
std::vector<AskedCase> asked_cases(const case_data::Case& result);

/// Asks `response` of a load case; notes where it knows no worst direction.
void ask(CaseContext& context, case_data::SourceLine line,
         const AskedCase& asked, case_data::ResponseEntry& response);

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
