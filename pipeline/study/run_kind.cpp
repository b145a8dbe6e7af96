#include "pipeline/study/run_kind.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/case_data/response_entries.h"
#include "pipeline/case_data/studied_responses.h"
#include "pipeline/responses/responses.h"
#include "pipeline/store/incumbent.h"

namespace meniscus::study {

namespace {

optimize::ResidualAnswer answer(const MatchTargets& targets,
                                const store::EvaluationRecord& record) {
  optimize::ResidualAnswer found;
  found.failure = record.failure;
  if (!record.failure) {
    found.residuals = targets.residuals(record.responses);
    found.mismatch = targets.mismatch(record.responses);
  }
  return found;
}

StudyOutcome analyse(const StudyTask& task) {
  task.evaluator.evaluate(task.start, "start");
  return {.status = RunStatus::Converged,
          .message = "analysed the initial design",
          .best = task.start};
}

/// Empty where a response of the targets has no derivatives.
optimize::JacobianFunction match_jacobian(const StudyTask& task) {
  if (!uses_gradients(task.input)) {
    return {};
  }
  return [&task, responses = case_data::studied_responses(task.input)](
             const VectorX& x) {
    optimize::JacobianAnswer answer = task.evaluator.gradient(x, responses);
    if (!answer.failure) {
      answer.jacobian = task.targets->jacobian(answer.jacobian);
    }
    return answer;
  };
}

std::vector<Constraint> constraints_of(const case_data::StudyEntry& study,
                                       const MatchTargets& targets,
                                       const VectorX& mismatch) {
  std::vector<Constraint> constraints;
  for (Eigen::Index k = 0; k < mismatch.size(); ++k) {
    constraints.push_back({.name = targets.name(k),
                           .value = mismatch[k],
                           .bound = study.tolerance,
                           .satisfied = mismatch[k] <= study.tolerance});
  }
  return constraints;
}

StudyOutcome match(const StudyTask& task) {
  const case_data::StudyEntry& study = task.input.study;
  if (study.fit) {
    return fit_scan(task);
  }
  std::string phase = "start";
  const optimize::MatchReport report = meniscus::optimize::match(
      variables_of(task.input, task.start),
      [&](const VectorX& x) {
        return answer(*task.targets, task.evaluator.evaluate(x, phase));
      },
      {.method = study.method,
       .tolerance = study.tolerance,
       .max_evaluations = study.max_evaluations,
       .earlier_evaluations = study.earlier_evaluations,
       .time_limit = task.options.time_limit,
       .monitor = task.options.monitor,
       .announce =
           [&](optimize::EvaluationPhase next) {
             phase = optimize::name_of(next);
           },
       .jacobian = match_jacobian(task),
       .prefetch = prefetch_of(task)});
  StudyOutcome outcome{.status = status_of(report.termination),
                       .message = report.message,
                       .best = report.best,
                       .objective = report.cost,
                       .jacobian = report.jacobian};
  if (report.answer.mismatch.size() > 0) {
    outcome.constraints =
        constraints_of(study, *task.targets, report.answer.mismatch);
  }
  return outcome;
}

}  // namespace

std::vector<Constraint> bound_constraints(const case_data::Case& input,
                                          const VectorX& responses) {
  std::vector<Constraint> constraints;
  for (const case_data::ConstraintEntry& entry : input.study.constraints) {
    const double value = responses[entry.response];
    constraints.push_back(
        {.name = input.responses[static_cast<std::size_t>(entry.response)].name,
         .value = value,
         .bound = nearer_bound(entry.lower, entry.upper, value),
         .satisfied = store::violation_of(entry, value) <= store::kFeasible});
  }
  return constraints;
}

std::string missed_bounds(const case_data::Case& input,
                          const std::vector<Constraint>& constraints) {
  const bool bound = input.study.kind != case_data::StudyKind::Match;
  std::string missed;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const Constraint& c = constraints[k];
    const ShownUnit unit =
        bound
            ? case_data::shown_unit(input, input.study.constraints[k].response)
            : ShownUnit{};
    if (!c.satisfied) {
      missed += fmt::format("{}'{}' is {} and its bound {}",
                            missed.empty() ? "" : ", ", c.name,
                            unit.text(c.value), unit.text(c.bound));
    }
  }
  return missed;
}

std::vector<Constraint> match_constraints(const case_data::Case& input,
                                          const MatchTargets* targets,
                                          const VectorX& responses) {
  const case_data::StudyEntry& study = input.study;
  if (targets != nullptr) {
    return constraints_of(study, *targets, targets->mismatch(responses));
  }
  if (!(study.tolerance > 0.0)) {
    return {};
  }
  const double value = responses[*study.fit];
  return {{.name = input.responses[static_cast<std::size_t>(*study.fit)].name,
           .value = value,
           .bound = study.tolerance,
           .satisfied = value <= study.tolerance}};
}

double nearer_bound(double lower, double upper, double value) {
  const bool above = value > 0.5 * (lower + upper);
  return !std::isfinite(lower) || (std::isfinite(upper) && above) ? upper
                                                                  : lower;
}

RunStatus status_of(optimize::Termination termination) {
  switch (termination) {
    case optimize::Termination::Converged:
      return RunStatus::Converged;
    case optimize::Termination::LimitReached:
      return RunStatus::Stopped;
    case optimize::Termination::Stalled:
    case optimize::Termination::AtBound:
    case optimize::Termination::NoFeasible:
    case optimize::Termination::Infeasible:
    case optimize::Termination::Constant:
    case optimize::Termination::NoFreedom:
      return RunStatus::Infeasible;
  }
  return RunStatus::Error;
}

std::function<void(const std::vector<VectorX>&)> prefetch_of(
    const StudyTask& task) {
  return [&task](const std::vector<VectorX>& designs) {
    task.evaluator.prefetch(
        designs, optimize::name_of(optimize::EvaluationPhase::Difference));
  };
}

bool all_kept(const std::vector<Constraint>& constraints) {
  return std::all_of(constraints.begin(), constraints.end(),
                     [](const Constraint& c) { return c.satisfied; });
}

StudyOutcome conduct(const StudyTask& task) {
  task.evaluator.limit_time(task.options.time_limit);
  switch (task.input.study.kind) {
    case case_data::StudyKind::Analyse:
      return analyse(task);
    case case_data::StudyKind::Match:
      return match(task);
    case case_data::StudyKind::Minimize:
      return minimize(task);
    case case_data::StudyKind::Sweep:
      return sweep(task);
    case case_data::StudyKind::Tolerance:
      return tolerance(task);
    case case_data::StudyKind::Pareto:
      return pareto(task);
  }
  return {};
}

bool uses_gradients(const case_data::Case& input) {
  const std::vector<int> responses = case_data::studied_responses(input);
  return case_data::asks_for_gradients(input.study) && !responses.empty() &&
         input.analysis.solver != equations::SolverKind::Distributed &&
         std::all_of(responses.begin(), responses.end(), [&](int r) {
           return case_data::has_derivatives(input, r);
         });
}

std::vector<optimize::Variable> variables_of(const case_data::Case& input,
                                             const VectorX& start,
                                             double reach) {
  std::vector<optimize::Variable> variables;
  variables.reserve(input.design.size());
  for (const case_data::DesignVariable& v : input.design) {
    const auto k = static_cast<Eigen::Index>(variables.size());
    optimize::Variable variable{.name = v.name,
                                .initial = start[k],
                                .lower = v.lower,
                                .upper = v.upper};
    variable.shown = case_data::shown_unit(input, v);
    const double range = v.upper - v.lower;
    if (reach < 1.0 && range > 0.0) {
      variable.lower = std::max(v.lower, start[k] - reach * range);
      variable.upper = std::min(v.upper, start[k] + reach * range);
      variable.range = range;
    }
    variables.push_back(std::move(variable));
  }
  for (const case_data::DesignRow& row : case_data::design_rows(input)) {
    for (std::size_t k = row.first; k < row.first + row.count; ++k) {
      variables[k].group = row.vector == nullptr ? "" : row.name;
    }
  }
  return variables;
}

}  // namespace meniscus::study
