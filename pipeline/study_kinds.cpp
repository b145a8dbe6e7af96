#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimize/minimize.h"
#include "pipeline/responses.h"
#include "pipeline/studied_responses.h"
#include "pipeline/study_runner.h"

namespace meniscus {

namespace {

RunStatus status_of(Termination termination) {
  switch (termination) {
    case Termination::Converged:
      return RunStatus::Converged;
    case Termination::LimitReached:
      return RunStatus::Stopped;
    case Termination::Stalled:
    case Termination::AtBound:
    case Termination::NoFeasible:
    case Termination::Infeasible:
    case Termination::Constant:
    case Termination::NoFreedom:
      return RunStatus::Infeasible;
  }
  return RunStatus::Error;
}

/// Rows or entries of `all` at `indices`.
VectorX picked(const VectorX& all, const std::vector<int>& indices) {
  VectorX result(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = all[indices[k]];
  }
  return result;
}

}  // namespace

bool uses_gradients(const Case& input) {
  const std::vector<int> responses = studied_responses(input);
  return asks_for_gradients(input.study) && !responses.empty() &&
         input.analysis.solver != SolverKind::Distributed &&
         std::all_of(responses.begin(), responses.end(),
                     [&](int r) { return has_derivatives(input, r); });
}

std::vector<Variable> variables_of(const Case& input, const VectorX& begin) {
  std::vector<Variable> variables;
  for (const DesignVariable& v : input.design) {
    variables.push_back({.name = v.name,
                         .initial = begin[std::ssize(variables)],
                         .lower = v.lower,
                         .upper = v.upper});
  }
  return variables;
}

ResidualAnswer StudyRunner::answer(const MatchTargets& targets,
                                   const EvaluationRecord& record) {
  ResidualAnswer found;
  found.failure = record.failure;
  if (!record.failure) {
    found.residuals = targets.residuals(record.responses);
    found.mismatch = targets.mismatch(record.responses);
  }
  return found;
}

void StudyRunner::analyse() {
  result_.status = RunStatus::Converged;
  result_.message = "analysed the initial design";
  best_design_ = initial_design(input_);
}

/// Empty where a response of the targets has no derivatives.
JacobianFunction StudyRunner::match_jacobian() {
  if (!with_gradients_) {
    return {};
  }
  const std::vector<int> responses = studied_responses(input_);
  return [this, responses](const VectorX& x) {
    JacobianAnswer answer = gradient(x, responses);
    if (!answer.failure) {
      answer.jacobian = targets_->jacobian(answer.jacobian);
    }
    return answer;
  };
}

void StudyRunner::match() {
  const MatchReport report = meniscus::match(
      variables_of(input_, begin_),
      [&](const VectorX& x) { return answer(*targets_, evaluate(x, phase_)); },
      {.method = input_.study.method,
       .tolerance = input_.study.tolerance,
       .max_evaluations = input_.study.max_evaluations,
       .time_limit = options_.time_limit,
       .monitor = options_.monitor,
       .announce = [&](EvaluationPhase phase) { phase_ = name_of(phase); },
       .jacobian = match_jacobian()});
  result_.status = status_of(report.termination);
  result_.message = report.message;
  result_.objective = report.cost;
  best_design_ = report.best;
  jacobian_ = report.jacobian;
  for (Eigen::Index k = 0; k < report.answer.mismatch.size(); ++k) {
    const double value = report.answer.mismatch[k];
    result_.constraints.push_back(
        {.name = targets_->name(k),
         .value = value,
         .bound = input_.study.tolerance,
         .satisfied = value <= input_.study.tolerance});
  }
}

/// The objective and the constraints as the optimizer sees them.
MinimizeProblem StudyRunner::minimize_problem() {
  MinimizeProblem problem;
  problem.variables = variables_of(input_, begin_);
  problem.objective = input_.responses[input_.study.objective].name;
  for (const ConstraintEntry& constraint : input_.study.constraints) {
    problem.constraints.push_back(
        {.name = input_.responses[constraint.response].name,
         .lower = constraint.lower,
         .upper = constraint.upper});
  }
  const std::vector<int> responses = studied_responses(input_);
  problem.function = [this, responses](const VectorX& x) {
    const EvaluationRecord record = evaluate(x, phase_);
    VectorAnswer answer{.values = {}, .failure = record.failure};
    if (!record.failure) {
      answer.values = picked(record.responses, responses);
    }
    return answer;
  };
  if (with_gradients_) {
    problem.jacobian = [this, responses](const VectorX& x) {
      JacobianAnswer answer = gradient(x, responses);
      if (!answer.failure) {
        answer.jacobian =
            Eigen::MatrixXd(answer.jacobian(responses, Eigen::all));
      }
      return answer;
    };
  }
  return problem;
}

void StudyRunner::minimize() {
  const MinimizeReport report = meniscus::minimize(
      minimize_problem(),
      {.method = input_.study.method,
       .optimality_tolerance = input_.study.tolerance,
       .max_evaluations = input_.study.max_evaluations,
       .time_limit = options_.time_limit,
       .monitor = options_.monitor,
       .announce = [&](EvaluationPhase phase) { phase_ = name_of(phase); }});
  result_.status = status_of(report.termination);
  result_.message = report.message;
  result_.objective = report.objective;
  best_design_ = report.best;
  for (const ConstraintState& state : report.constraints) {
    const bool above = state.value > 0.5 * (state.lower + state.upper);
    const bool upper =
        !std::isfinite(state.lower) || (std::isfinite(state.upper) && above);
    result_.constraints.push_back({.name = state.name,
                                   .value = state.value,
                                   .bound = upper ? state.upper : state.lower,
                                   .satisfied = state.satisfied});
  }
}

}  // namespace meniscus
