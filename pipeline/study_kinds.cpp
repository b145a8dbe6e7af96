#include "pipeline/study_kinds.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "pipeline/responses.h"
#include "pipeline/studied_responses.h"

namespace meniscus {

namespace {

ResidualAnswer answer(const MatchTargets& targets,
                      const EvaluationRecord& record) {
  ResidualAnswer found;
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
JacobianFunction match_jacobian(const StudyTask& task) {
  if (!uses_gradients(task.input)) {
    return {};
  }
  return [&task, responses = studied_responses(task.input)](const VectorX& x) {
    JacobianAnswer answer = task.evaluator.gradient(x, responses);
    if (!answer.failure) {
      answer.jacobian = task.targets->jacobian(answer.jacobian);
    }
    return answer;
  };
}

StudyOutcome match(const StudyTask& task) {
  const StudyEntry& study = task.input.study;
  if (study.fit) {
    return fit_scan(task);
  }
  std::string phase = "start";
  const MatchReport report = meniscus::match(
      variables_of(task.input, task.start),
      [&](const VectorX& x) {
        return answer(*task.targets, task.evaluator.evaluate(x, phase));
      },
      {.method = study.method,
       .tolerance = study.tolerance,
       .max_evaluations = study.max_evaluations,
       .time_limit = task.options.time_limit,
       .monitor = task.options.monitor,
       .announce = [&](EvaluationPhase next) { phase = name_of(next); },
       .jacobian = match_jacobian(task),
       .prefetch = prefetch_of(task)});
  StudyOutcome outcome{.status = status_of(report.termination),
                       .message = report.message,
                       .best = report.best,
                       .objective = report.cost,
                       .jacobian = report.jacobian};
  for (Eigen::Index k = 0; k < report.answer.mismatch.size(); ++k) {
    const double value = report.answer.mismatch[k];
    outcome.constraints.push_back({.name = task.targets->name(k),
                                   .value = value,
                                   .bound = study.tolerance,
                                   .satisfied = value <= study.tolerance});
  }
  return outcome;
}

std::vector<int> matched_responses(const Case& input) {
  std::set<int> result;
  for (const std::string& name : input.study.equal) {
    result.insert(response_index(input, name));
  }
  for (const auto& target : input.study.targets) {
    result.insert(response_index(input, target.first));
  }
  return {result.begin(), result.end()};
}

std::vector<int> minimized_responses(const Case& input) {
  std::vector<int> result;
  if (input.study.objective) {
    result.push_back(*input.study.objective);
  }
  for (const ConstraintEntry& constraint : input.study.constraints) {
    result.push_back(constraint.response);
  }
  if (input.study.second) {
    result.push_back(*input.study.second);
  }
  return result;
}

std::vector<int> differentiable_responses(const Case& input) {
  std::vector<int> result;
  for (int r = 0; r < static_cast<int>(input.responses.size()); ++r) {
    if (has_derivatives(input, r)) {
      result.push_back(r);
    }
  }
  return result;
}

std::vector<std::string> methods_of_minima() {
  std::vector<std::string> names;
  for (const MinimizeMethod& method : minimize_methods()) {
    names.push_back(method.name);
  }
  return names;
}

std::vector<std::string> sweep_methods() {
  return {"grid", "latin_hypercube", "sobol"};
}

/// A method may wait in the case, of any kind, while it is only analysed.
std::vector<std::string> methods_that_wait() {
  std::vector<std::string> names = match_methods();
  for (const auto& more : {methods_of_minima(), sweep_methods()}) {
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

bool by_ceres(const StudyEntry& study) { return study.method == "ceres"; }

bool by_slopes(const StudyEntry& study) {
  const MinimizeMethod* method = find_minimize_method(study.method);
  return method != nullptr && method->gradients;
}

int most_evaluations(const StudyEntry& study) { return study.max_evaluations; }

int designs_of_sweep(const StudyEntry& study) {
  int designs = study.method == "grid" ? 1 : study.count;
  for (const int level : study.levels) {
    designs *= study.method == "grid" ? std::max(level, 1) : 1;
  }
  return designs + 1;  // the start
}

}  // namespace

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

std::function<void(const std::vector<VectorX>&)> prefetch_of(
    const StudyTask& task) {
  return [&task](const std::vector<VectorX>& designs) {
    task.evaluator.prefetch(designs, name_of(EvaluationPhase::Difference));
  };
}

const std::vector<StudyRow>& study_kinds() {
  using Kind = StudyKind;
  static const std::vector<StudyRow> rows = {
      {.name = "analyse",
       .kind = Kind::Analyse,
       .methods = methods_that_wait(),
       .usual_method = "ceres",
       .outer_stage = "match",
       .conduct = analyse,
       .gradients = by_ceres,
       .planned = [](const StudyEntry&) { return 1; }},
      {.name = "match",
       .kind = Kind::Match,
       .keys = {"equal", "targets", "fit", "tolerance", "max_evaluations",
                "coarse_first", "refreeze"},
       .methods = match_methods(),
       .usual_method = "ceres",
       .outer_stage = "match",
       .conduct = match,
       .responses = matched_responses,
       .gradients = by_ceres,
       .planned = most_evaluations},
      {.name = "minimize",
       .kind = Kind::Minimize,
       .keys = {"objective", "constraints", "tolerance", "max_evaluations",
                "coarse_first", "refreeze"},
       .methods = methods_of_minima(),
       .usual_method = "slsqp",
       .outer_stage = "minimize",
       .conduct = minimize,
       .responses = minimized_responses,
       .gradients = by_slopes,
       .planned = most_evaluations},
      {.name = "sweep",
       .kind = Kind::Sweep,
       .keys = {"objective", "constraints", "levels", "count", "seed"},
       .methods = sweep_methods(),
       .usual_method = "sobol",
       .outer_stage = "study",
       .conduct = sweep,
       .planned = designs_of_sweep},
      {.name = "tolerance",
       .kind = Kind::Tolerance,
       .keys = {"deviations", "count", "seed"},
       .methods = {"latin_hypercube", "sobol"},
       .usual_method = "latin_hypercube",
       .outer_stage = "study",
       .conduct = tolerance,
       .responses = differentiable_responses,
       .gradients = [](const StudyEntry&) { return true; },
       .planned = [](const StudyEntry& study) { return study.count + 1; }},
      {.name = "pareto",  // a chain of minimisations: nobody knows how many
       .kind = Kind::Pareto,
       .keys = {"objectives", "constraints", "count", "tolerance",
                "max_evaluations"},
       .methods = methods_of_minima(),
       .usual_method = "slsqp",
       .outer_stage = "minimize",
       .conduct = pareto,
       .responses = minimized_responses,
       .gradients = by_slopes}};
  return rows;
}

const StudyRow& row_of(StudyKind kind) {
  return *std::find_if(study_kinds().begin(), study_kinds().end(),
                       [&](const StudyRow& row) { return row.kind == kind; });
}

StudyOutcome conduct(const StudyTask& task) {
  task.evaluator.limit_time(task.options.time_limit);
  return row_of(task.input.study.kind).conduct(task);
}

bool uses_gradients(const Case& input) {
  const std::vector<int> responses = studied_responses(input);
  return asks_for_gradients(input.study) && !responses.empty() &&
         input.analysis.solver != SolverKind::Distributed &&
         std::all_of(responses.begin(), responses.end(),
                     [&](int r) { return has_derivatives(input, r); });
}

std::vector<Variable> variables_of(const Case& input, const VectorX& start) {
  std::vector<Variable> variables;
  variables.reserve(input.design.size());
  for (const DesignVariable& v : input.design) {
    const auto k = static_cast<Eigen::Index>(variables.size());
    variables.push_back({.name = v.name,
                         .initial = start[k],
                         .lower = v.lower,
                         .upper = v.upper});
  }
  return variables;
}

}  // namespace meniscus
