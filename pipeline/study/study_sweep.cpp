#include <algorithm>

#include <fmt/format.h>

#include "optimize/samples/sampling.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/store/incumbent.h"
#include "pipeline/study/run_kind.h"

namespace meniscus::study {

namespace {

/// Variables of a grid without levels stay where they start.
std::vector<VectorX> grid_designs(const case_data::Case& input,
                                  const VectorX& start) {
  std::vector<int> levels = input.study.levels;
  std::replace(levels.begin(), levels.end(), 0, 1);
  std::vector<VectorX> designs = samples::designs_of(
      variables_of(input, start), samples::grid_samples(levels));
  for (VectorX& design : designs) {
    for (std::size_t k = 0; k < levels.size(); ++k) {
      if (input.study.levels[k] == 0) {
        const auto j = static_cast<Eigen::Index>(k);
        design[j] = start[j];
      }
    }
  }
  return designs;
}

Constraint constraint_of(const case_data::Case& input,
                         const case_data::ConstraintEntry& entry,
                         double value) {
  return {.name = input.responses[entry.response].name,
          .value = value,
          .bound = nearer_bound(entry.lower, entry.upper, value),
          .satisfied = store::violation_of(entry, value) <= store::kFeasible};
}

/// The best design by objective and constraints, and what it comes to.
void choose_best(const StudyTask& task,
                 const std::vector<store::EvaluationRecord>& records,
                 StudyOutcome& outcome) {
  const case_data::StudyEntry& study = task.input.study;
  const store::EvaluationRecord* best = nullptr;
  for (const store::EvaluationRecord& record : records) {
    if (study.objective && !record.failure &&
        (best == nullptr ||
         store::is_better(store::merit_of(study, record.responses),
                          store::merit_of(study, best->responses)))) {
      best = &record;
    }
  }
  if (best == nullptr) {
    return;
  }
  const store::Merit standing = store::merit_of(study, best->responses);
  outcome.best = best->inputs;
  outcome.objective = standing.objective;
  outcome.constraints.reserve(study.constraints.size());
  for (const case_data::ConstraintEntry& entry : study.constraints) {
    outcome.constraints.push_back(
        constraint_of(task.input, entry, best->responses[entry.response]));
  }
  if (standing.feasible()) {
    const ShownUnit shown = case_data::shown_unit(task.input, *study.objective);
    outcome.message += fmt::format("; the best has {} = {}",
                                   task.input.responses[*study.objective].name,
                                   shown.text(standing.objective));
  } else if (outcome.status == RunStatus::Converged) {
    outcome.status = RunStatus::Infeasible;
    outcome.message += fmt::format(
        "; none keeps every constraint, the least violation is {:.2g} of a "
        "bound: loosen the bounds, or widen those of the design variables",
        standing.violation);
  }
}

}  // namespace

std::vector<VectorX> designs_of_sweep(const case_data::Case& input,
                                      const VectorX& start) {
  const case_data::StudyEntry& study = input.study;
  if (study.method == "grid") {
    return grid_designs(input, start);
  }
  const int variables = static_cast<int>(input.design.size());
  return samples::designs_of(
      variables_of(input, start),
      study.method == "sobol" ? samples::sobol_samples(variables, study.count)
                              : samples::latin_hypercube_samples(
                                    variables, study.count,
                                    static_cast<std::uint64_t>(study.seed)));
}

StudyOutcome sweep(const StudyTask& task) {
  const std::vector<VectorX> designs = designs_of_sweep(task.input, task.start);
  return outcome_of_sweep(task, static_cast<int>(designs.size()),
                          task.evaluator.evaluate_all(designs, "sweep"));
}

StudyOutcome outcome_of_sweep(
    const StudyTask& task, int designs,
    const std::vector<store::EvaluationRecord>& records) {
  StudyOutcome outcome{.best = task.start};
  outcome.sweep = sweep_figures(designs, records);
  const SweepFigures& figures = *outcome.sweep;
  if (figures.looked_at < figures.designs) {
    outcome.status = RunStatus::Stopped;
    outcome.message = fmt::format(
        "the time limit of {:g} s ended the sweep after {} of {} designs; go "
        "on with --resume",
        task.options.time_limit, figures.looked_at, figures.designs);
  } else if (figures.failed == figures.designs) {
    outcome.status = RunStatus::Failed;
    outcome.message = fmt::format(
        "none of the {} designs can be evaluated (the first: {}); bring the "
        "bounds of the design variables nearer to their initial values, where "
        "the film holds",
        figures.designs, records.front().failure->message);
  } else {
    outcome.status = RunStatus::Converged;
    outcome.message = fmt::format("looked at all {} designs", figures.designs);
    if (figures.failed > 0) {
      outcome.message +=
          fmt::format(", {} of them cannot be evaluated", figures.failed);
    }
  }
  choose_best(task, records, outcome);
  return outcome;
}

}  // namespace meniscus::study
