/// What a sweep found: each response's range, and where.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::study {

struct ResponseRange {
  double least = 0.0;
  double largest = 0.0;
  double mean = 0.0;  // over all designs that answered
  VectorX least_at;   // the first such design
  VectorX largest_at;
};

struct SweepFigures {
  int designs = 0;    // that the sweep consists of
  int looked_at = 0;  // fewer when the time was up
  int failed = 0;     // of those
  /// By kind ("film_unstable"), alphabetically.
  std::vector<std::pair<std::string, int>> failures;
  std::vector<ResponseRange> responses;  // in the case's order; empty when
                                         // no design answered
};

/// `records`: of the designs looked at, in order; `designs`: of all.
SweepFigures sweep_figures(int designs,
                           const std::vector<store::EvaluationRecord>& records);

/// The part `sweep` of result.json (docs/results.md).
nlohmann::ordered_json sweep_json(const case_data::Case& input,
                                  const SweepFigures& figures);

/// A line per response for people.
std::string sweep_text(const case_data::Case& input,
                       const SweepFigures& figures);

}  // namespace meniscus::study
