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

std::vector<RaisedMargin> raise_margins(const case_data::Case& input,
                                        const VectorX& responses,
                                        const VectorX& errors,
                                        case_data::Case& working) {
  std::vector<RaisedMargin> raised;
  for (accuracy::DoubtedMargin& margin :
       accuracy::doubted_margins(input, responses, errors)) {
    double& lower = working.study.constraints[margin.constraint].lower;
    if (lower > 0.0) {
      lower = accuracy::raised_bound(margin, lower);
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
  for (const accuracy::DoubtedMargin& margin : accuracy::doubted_margins(
           input, result.best->responses, result.response_errors)) {
    for (Constraint& constraint : result.constraints) {
      if (constraint.name == margin.name) {
        constraint.satisfied = false;
      }
    }
    const std::string note = fmt::format(
        "'{}' is {} and {}: the film may be there on this mesh alone, so "
        "the bound is not kept; raise it{}, or shorten resolution.fea",
        margin.name, margin.shown.text(margin.value, 2),
        accuracy::doubt_text(margin),
        std::isfinite(margin.error) ? " above the error" : "");
    result.message += ". " + note;
    result.warnings.push_back(note);
    if (result.status == RunStatus::Converged) {
      result.status = RunStatus::Infeasible;
    }
  }
}

}  // namespace meniscus::study
