#include "pipeline/study/held_margins.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/accuracy/mesh_errors.h"

namespace meniscus::study {

bool holds_margins(const case_data::Case& working) {
  const auto& constraints = working.study.constraints;
  return working.study.kind == case_data::StudyKind::Minimize &&
         std::any_of(constraints.begin(), constraints.end(),
                     [&](const auto& entry) {
                       return accuracy::holds_margin(working, entry) &&
                              entry.lower > 0.0;
                     });
}

bool nears_margins(const case_data::Case& working, const VectorX& responses) {
  const auto& constraints = working.study.constraints;
  return std::any_of(
      constraints.begin(), constraints.end(), [&](const auto& entry) {
        return accuracy::holds_margin(working, entry) &&
               accuracy::is_near_bound(responses[entry.response], entry.lower);
      });
}

std::vector<RaisedMargin> raise_margins(const case_data::Case& input,
                                        const VectorX& responses,
                                        const VectorX& errors, Raise raise,
                                        case_data::Case& working) {
  const bool doubted = raise == Raise::Doubted;
  std::vector<RaisedMargin> raised;
  for (accuracy::HeldMargin& margin :
       doubted ? accuracy::doubted_margins(input, responses, errors)
               : accuracy::held_margins(input, responses, errors)) {
    double& lower = working.study.constraints[margin.constraint].lower;
    if (!(lower > 0.0)) {
      continue;
    }
    const double bound = doubted ? accuracy::raised_bound(margin, lower)
                                 : accuracy::foreseen_bound(margin, lower);
    if (bound > lower) {
      lower = bound;
      raised.push_back({.margin = std::move(margin), .lower = lower});
    }
  }
  return raised;
}

void doubt_margins(const case_data::Case& input, RunResult& result) {
  if (input.study.kind != case_data::StudyKind::Minimize ||
      result.response_errors.size() == 0) {
    return;
  }
  for (const accuracy::HeldMargin& margin : accuracy::doubted_margins(
           input, result.best->responses, result.response_errors)) {
    for (Constraint& constraint : result.constraints) {
      if (constraint.name == margin.name) {
        constraint.satisfied = false;
      }
    }
    const bool may_be_lost = !(margin.value > margin.error);
    const std::string note = fmt::format(
        "'{}' is {} and {}: {}, so the bound is not kept; raise it{}, or "
        "shorten resolution.fea",
        margin.name, margin.shown.text(margin.value, 2),
        accuracy::doubt_text(margin),
        may_be_lost
            ? "the film may be there on this mesh alone"
            : "it may miss its bound of " + margin.shown.text(margin.lower, 2) +
                  " on shorter edges",
        std::isfinite(margin.error) ? " by the error" : "");
    result.message += ". " + note;
    result.warnings.push_back(note);
    if (result.status == RunStatus::Converged) {
      result.status = RunStatus::Infeasible;
    }
  }
}

}  // namespace meniscus::study
