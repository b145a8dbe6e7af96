#include "pipeline/case_data/studied_responses.h"
#include "pipeline/study/run_kind.h"

namespace meniscus::study {

namespace {

/// Rows or entries of `all` at `indices`.
VectorX select(const VectorX& all, const std::vector<int>& indices) {
  VectorX result(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = all[indices[k]];
  }
  return result;
}

}  // namespace

optimize::MinimizeProblem minimize_problem(const StudyTask& task,
                                           const std::string& phase) {
  const case_data::Case& input = task.input;
  optimize::MinimizeProblem problem;
  problem.variables = variables_of(input, task.start, task.reach);
  problem.objective = input.responses[*input.study.objective].name;
  problem.shown = case_data::shown_unit(input, *input.study.objective);
  for (const case_data::ConstraintEntry& constraint : input.study.constraints) {
    const case_data::ResponseEntry& response =
        input.responses[static_cast<std::size_t>(constraint.response)];
    problem.constraints.push_back(
        {.name = response.name,
         .lower = constraint.lower,
         .upper = constraint.upper,
         .root_like = response.kind == case_data::ResponseKind::CollapseMargin,
         .shown = case_data::shown_unit(input, constraint.response)});
  }
  if (input.study.second) {
    problem.constraints.push_back(
        {.name = input.responses[*input.study.second].name,
         .shown = case_data::shown_unit(input, *input.study.second)});
  }
  const std::vector<int> responses = case_data::studied_responses(input);
  problem.function = [&task, &phase, responses](const VectorX& x) {
    const store::EvaluationRecord record = task.evaluator.evaluate(x, phase);
    optimize::VectorAnswer answer{.values = {}, .failure = record.failure};
    if (!record.failure) {
      answer.values = select(record.responses, responses);
    }
    return answer;
  };
  if (uses_gradients(input)) {
    problem.jacobian = [&task, responses](const VectorX& x) {
      optimize::JacobianAnswer answer = task.evaluator.gradient(x, responses);
      if (!answer.failure) {
        answer.jacobian =
            Eigen::MatrixXd(answer.jacobian(responses, Eigen::all));
      }
      return answer;
    };
  }
  return problem;
}

Constraint to_constraint(const optimize::ConstraintState& state) {
  return {.name = state.name,
          .value = state.value,
          .bound = nearer_bound(state.lower, state.upper, state.value),
          .satisfied = state.satisfied};
}

optimize::MinimizeOptions minimize_options(const StudyTask& task,
                                           std::string& phase) {
  const case_data::StudyEntry& study = task.input.study;
  return {.method = study.method,
          .optimality_tolerance = study.tolerance,
          .max_evaluations = study.max_evaluations,
          .earlier_evaluations = study.earlier_evaluations,
          .time_limit = task.options.time_limit,
          .monitor = task.options.monitor,
          .announce =
              [&phase](optimize::EvaluationPhase next) {
                phase = optimize::name_of(next);
              },
          .prefetch = prefetch_of(task)};
}

StudyOutcome minimize(const StudyTask& task) {
  std::string phase = "start";
  const optimize::MinimizeReport report = meniscus::optimize::minimize(
      minimize_problem(task, phase), minimize_options(task, phase));
  // A search that stalled where all is kept has an answer, not a proof.
  const bool kept =
      report.termination == optimize::Termination::Stalled && report.feasible;
  StudyOutcome outcome{
      .status = kept ? RunStatus::Stopped : status_of(report.termination),
      .message = report.message,
      .best = report.best,
      .unproven = kept,
      .objective = report.objective,
      .multipliers =
          optimize::multipliers(variables_of(task.input, task.start), report)};
  for (const optimize::ConstraintState& state : report.constraints) {
    outcome.constraints.push_back(to_constraint(state));
  }
  return outcome;
}

}  // namespace meniscus::study
