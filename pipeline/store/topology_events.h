/// Where a study left the films that its models have: lines that run together,
/// a film that shrinks away, a neck that closes. No frozen model goes on there.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/store/study_store.h"

namespace meniscus::store {

struct TopologyEvent {
  FailureKind kind = FailureKind::FilmRejoins;  // or FilmPinched
  int designs = 0;                              // that failed so
  // Of these the one nearest to the initial design:
  int evaluation = 0;  // its number in the database
  VectorX design;
  std::string message;  // what happens there, and where
};

/// One of each kind that the records have.
std::vector<TopologyEvent> topology_events(
    const case_data::Case& input, const std::vector<EvaluationRecord>& records);

/// "films join in another way at 3 designs, the nearest evaluation 12, ...".
std::string event_text(const case_data::Case& input,
                       const TopologyEvent& event);

}  // namespace meniscus::store
