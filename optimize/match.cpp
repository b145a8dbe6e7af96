#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "optimize/ceres_match.h"
#include "optimize/first_start.h"
#include "optimize/free_variables.h"
#include "optimize/nlopt_match.h"
#include "optimize/problem.h"

namespace meniscus::optimize {
namespace {

constexpr const char* kCeres = "ceres";

void check_method(const std::string& method) {
  const std::vector<std::string> names = match_methods();
  if (std::find(names.begin(), names.end(), method) == names.end()) {
    throw InvalidInput(
        fmt::format("match: method '{}' is not known; there are "
                    "{}",
                    method, fmt::join(names, ", ")));
  }
}

std::optional<VectorX> match_start(MatchEvaluator& evaluator) {
  return find_start(
      evaluator,
      [&](const VectorX& x, EvaluationPhase phase) -> std::optional<bool> {
        const ResidualAnswer* answer = evaluator.evaluate(x, phase);
        if (answer == nullptr) {
          return std::nullopt;
        }
        return !answer->failure;
      });
}

bool is_flat(const MatchEvaluator& evaluator, const BackendResult& backend) {
  return (backend.jacobian.size() > 0 && backend.jacobian.isZero(0.0) &&
          evaluator.failed_evaluations() == 0) ||
         (evaluator.evaluations() - evaluator.failed_evaluations() > 1 &&
          evaluator.all_answers_equal());
}

// What to change, before "allow more".
std::string match_advice(const MatchEvaluator& evaluator, const VectorX& best) {
  const std::string bounds = evaluator.bounds_reached(best);
  if (!bounds.empty()) {
    return fmt::format("Widen the bounds ({}), or ", bounds);
  }
  return 2 * evaluator.failed_evaluations() > evaluator.evaluations()
             ? "Most designs within the bounds cannot be evaluated: see why, "
               "tighten the bounds around those that can, or "
             : "Add a design variable, start elsewhere, or ";
}

void set_stalled(const MatchEvaluator& evaluator, const std::string& figures,
                 const BackendResult& backend, MatchReport& report) {
  report.termination = Termination::Stalled;
  const std::string bounds = evaluator.bounds_reached(report.best);
  if (is_flat(evaluator, backend)) {
    report.termination = Termination::Constant;
    report.message = fmt::format(
        "the mismatch does not change with any design variable: {}. Choose "
        "variables that move the targets, or loads and targets that feel them",
        figures);
  } else if (!bounds.empty()) {
    report.termination = Termination::AtBound;
    report.message = fmt::format(
        "the best design found stands at a bound: {}, {}. Widen the "
        "bounds or free another variable",
        figures, bounds);
  } else {
    report.message = fmt::format(
        "no better design found ({}): {}. Add a design variable, loosen the "
        "tolerance, or start elsewhere",
        backend.message, figures);
  }
}

void finish_report(const MatchEvaluator& evaluator,
                   const BackendResult& backend, MatchReport& report) {
  if (!evaluator.has_best()) {
    report.termination = Termination::NoFeasible;
    report.message = no_start_message(evaluator);
    return;
  }
  report.best = evaluator.best();
  report.answer = evaluator.best_answer();
  report.cost = cost_of(report.answer);
  const std::string figures = fmt::format(
      "largest mismatch {:.3g} against a tolerance of {:.3g} at {} after {}{}",
      worst_mismatch(report.answer), evaluator.options().tolerance,
      evaluator.describe(report.best),
      evaluations_text(evaluator.evaluations(),
                       evaluator.options().earlier_evaluations),
      evaluator.failures());
  switch (evaluator.halt()) {
    case MatchEvaluator::Halt::Converged:
      report.termination = Termination::Converged;
      report.message = "matched: " + figures;
      break;
    case MatchEvaluator::Halt::Evaluations:
      if (is_flat(evaluator, backend)) {
        set_stalled(evaluator, figures, backend, report);
        break;
      }
      report.termination = Termination::LimitReached;
      report.message =
          fmt::format("stopped at the {}: {}. {}allow more evaluations",
                      limit_text(evaluator.options().max_evaluations,
                                 evaluator.options().earlier_evaluations),
                      figures, match_advice(evaluator, report.best));
      break;
    case MatchEvaluator::Halt::Time:
      report.termination = Termination::LimitReached;
      report.message = fmt::format(
          "stopped at the time limit of {} s: {}. {}allow more time",
          evaluator.options().time_limit, figures,
          match_advice(evaluator, report.best));
      break;
    default:
      set_stalled(evaluator, figures, backend, report);
  }
}

void finish(const MatchEvaluator& evaluator, const BackendResult& backend,
            MatchReport& report) {
  report.evaluations = evaluator.evaluations();
  report.failed_evaluations = evaluator.failed_evaluations();
  report.gradient_evaluations = evaluator.gradient_evaluations();
  report.iterations = backend.iterations;
  report.jacobian = backend.jacobian;
  finish_report(evaluator, backend, report);
  const VectorX& error = evaluator.options().mismatch_error;
  if (error.size() > 0 && error.maxCoeff() > evaluator.options().tolerance) {
    report.message += fmt::format(
        ". The tolerance {:.1e} is below the mesh's own error of the mismatch, "
        "about {:.1e}: shorten the edges to trust more digits",
        evaluator.options().tolerance, error.maxCoeff());
  }
}

MatchReport match_all(const std::vector<Variable>& variables,
                      const ResidualFunction& function,
                      const MatchOptions& options) {
  MatchEvaluator evaluator(variables, function, options);
  BackendResult backend;
  const std::optional<VectorX> start = match_start(evaluator);
  if (start) {
    backend = options.method == kCeres
                  ? ceres_match(evaluator, *start)
                  : nlopt_match(evaluator, *start, options.method);
  }
  evaluator.rethrow();
  MatchReport report;
  finish(evaluator, backend, report);
  return report;
}

// No variable moves: one evaluation says what there is.
MatchReport match_held(const std::vector<Variable>& variables,
                       const ResidualFunction& function,
                       const MatchOptions& options, const FreeVariables& free) {
  MatchEvaluator evaluator(variables, function, options);
  evaluator.evaluate(evaluator.start(), EvaluationPhase::Start);
  evaluator.rethrow();
  MatchReport report;
  finish(evaluator, {}, report);
  if (report.termination != Termination::Converged &&
      report.termination != Termination::NoFeasible) {
    report.termination = Termination::NoFreedom;
    report.message = free.held_message();
  }
  return report;
}

// Some variables are held: the search sees the others.
MatchReport match_free(const FreeVariables& free,
                       const ResidualFunction& function,
                       const MatchOptions& options) {
  MatchOptions inner = options;
  if (options.jacobian) {
    inner.jacobian = [&](const VectorX& x) {
      JacobianAnswer answer = options.jacobian(free.expanded(x));
      answer.jacobian = free.reduced(answer.jacobian);
      return answer;
    };
  }
  if (options.prefetch) {
    inner.prefetch = [&](const std::vector<VectorX>& points) {
      options.prefetch(free.expanded(points));
    };
  }
  MatchReport report = match_all(
      free.free(),
      [&](const VectorX& x) {
        ResidualAnswer answer = function(free.expanded(x));
        if (answer.jacobian) {
          answer.jacobian = free.reduced(*answer.jacobian);
        }
        return answer;
      },
      inner);
  if (report.best.size() > 0) {
    report.best = free.expanded(report.best);
  }
  report.jacobian = free.widened(report.jacobian);
  if (report.answer.jacobian) {
    report.answer.jacobian = free.widened(*report.answer.jacobian);
  }
  return report;
}

}  // namespace

const char* name_of(EvaluationPhase phase) {
  switch (phase) {
    case EvaluationPhase::Start:
      return "start";
    case EvaluationPhase::Probe:
      return "probe";
    case EvaluationPhase::Difference:
      return "difference";
    case EvaluationPhase::Step:
      return "step";
    case EvaluationPhase::Gradient:
      return "gradient";
  }
  return "unknown";
}

const char* name_of(Termination termination) {
  switch (termination) {
    case Termination::Converged:
      return "converged";
    case Termination::Stalled:
      return "stalled";
    case Termination::AtBound:
      return "at_bound";
    case Termination::NoFeasible:
      return "no_feasible";
    case Termination::Infeasible:
      return "infeasible";
    case Termination::Constant:
      return "constant";
    case Termination::NoFreedom:
      return "no_freedom";
    case Termination::LimitReached:
      return "limit_reached";
  }
  return "unknown";
}

MatchReport match(const std::vector<Variable>& variables,
                  const ResidualFunction& function,
                  const MatchOptions& options) {
  check_method(options.method);
  check_variables(variables, "match");
  const FreeVariables free(variables);
  if (free.all_held()) {
    return match_held(variables, function, options, free);
  }
  return free.any_held() ? match_free(free, function, options)
                         : match_all(variables, function, options);
}

std::vector<std::string> match_methods() {
  std::vector<std::string> names = {kCeres};
  const std::vector<std::string>& nlopt = nlopt_match_methods();
  names.insert(names.end(), nlopt.begin(), nlopt.end());
  return names;
}

}  // namespace meniscus::optimize
