/// What a family came to: one table, for programs and for people.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/study/study.h"

namespace meniscus::results {

/// One member: a row of the table. Numbers are those of its result.json.
struct FamilyRow {
  using Numbers = std::vector<std::pair<std::string, double>>;
  std::string name;
  std::string folder;  // relative to the family's
  std::string parent;  // whose answer it started from; empty: its own initial
  std::string status;  // as in its result.json; "waiting" before it has one
  std::string message;
  Numbers parameters;
  Numbers design;     // the best one; empty: none
  Numbers responses;  // there, in the case's units
  Numbers errors;     // of those that have one: estimated, the same units
  std::vector<std::string> at_bound;  // design variables, "foot (lower)"
  double objective = 0.0;
  std::vector<study::Constraint> constraints;
  int evaluations = 0;
  double seconds = 0.0;

  bool is_converged() const { return status == "converged"; }
};

struct FamilyResult {
  study::RunStatus status = study::RunStatus::Error;
  std::string message;
  std::vector<FamilyRow> rows;  // in the order of the case
  double total_seconds = 0.0;
  std::vector<std::string> warnings;
};

/// The row of a member that has a result.json; `member` names its parts.
FamilyRow family_row(const case_data::Case& member,
                     const nlohmann::ordered_json& result);

/// Head line: member, status, parent, each parameter, design variable,
/// response and NAME_error of those that some member has, then objective,
/// evaluations, seconds, at_bound, missed (constraints not kept), message.
/// Numbers with the digits that bring the same double back.
std::string family_csv(const std::vector<FamilyRow>& rows);

/// The text of family_csv() as columns with six digits, errors beside what they
/// are of; messages of members that were not sized below. `units`, by name of a
/// response, go into the head line.
std::string family_table_text(
    const std::string& csv,
    const std::map<std::string, std::string>& units = {});

/// The family's result.json (docs/results.md).
nlohmann::ordered_json family_json(const case_data::Case& family,
                                   const FamilyResult& result,
                                   const std::string& program_version);

/// How many are sized, and which are not and why, in words; the status.
void set_status(FamilyResult& result);

}  // namespace meniscus::results
