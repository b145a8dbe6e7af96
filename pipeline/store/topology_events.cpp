#include "pipeline/store/topology_events.h"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/store/refreeze.h"

namespace meniscus::store {

std::vector<TopologyEvent> topology_events(
    const case_data::Case& input,
    const std::vector<EvaluationRecord>& records) {
  const VectorX initial = case_data::initial_design(input);
  std::vector<TopologyEvent> events;
  for (const FailureKind kind :
       {FailureKind::FilmRejoins, FailureKind::FilmPinched}) {
    TopologyEvent event{.kind = kind};
    double nearest = std::numeric_limits<double>::infinity();
    for (const EvaluationRecord& record : records) {
      if (!record.failure || record.failure->kind != kind) {
        continue;
      }
      ++event.designs;
      const double distance = design_distance(input, record.inputs, initial);
      if (distance < nearest) {
        nearest = distance;
        event.evaluation = record.number;
        event.design = record.inputs;
        event.message = record.failure->message;
      }
    }
    if (event.designs > 0) {
      events.push_back(std::move(event));
    }
  }
  return events;
}

std::string event_text(const case_data::Case& input,
                       const TopologyEvent& event) {
  return fmt::format(
      "{} at {} design{}, nearest to the start at evaluation {} ({}): {}{}",
      event.kind == FailureKind::FilmRejoins ? "films join in another way"
                                             : "a neck closes",
      event.designs, event.designs == 1 ? "" : "s", event.evaluation,
      case_data::design_text(input, event.design), event.message,
      event.kind == FailureKind::FilmRejoins && !input.resolution.pop
          ? "; drawn along one line there, films part anew by "
            "resolution.pop = true"
          : "");
}

}  // namespace meniscus::store
