#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "optimize/ceres_match.h"
#include "optimize/nlopt_match.h"
#include "optimize/problem.h"

namespace meniscus {
namespace {

constexpr const char* kCeres = "ceres";
// Points tried when the initial one fails: enough to find a region that is a
// fifth of the box or more with 90 % chance.
constexpr int kProbes = 10;
// A variable this close to a bound, x range, counts as being there.
constexpr double kAtBound = 1e-9;

void check_method(const std::string& method) {
  const std::vector<std::string> names = match_methods();
  if (std::find(names.begin(), names.end(), method) == names.end()) {
    throw InvalidInput(
        fmt::format("match: method '{}' is not known; there are "
                    "{}",
                    method, fmt::join(names, ", ")));
  }
}

// The radical inverse of `index` in `base`: Halton's sequence, spread evenly.
double radical_inverse(int index, int base) {
  double value = 0.0;
  double digit = 1.0;
  for (int rest = index; rest > 0; rest /= base) {
    digit /= base;
    value += digit * (rest % base);
  }
  return value;
}

VectorX probe_point(const MatchEvaluator& evaluator, int index) {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19};
  VectorX t(evaluator.size());
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    t[i] = radical_inverse(index, kPrimes[i % 8]);
  }
  return evaluator.lower() + t.cwiseProduct(evaluator.ranges());
}

// The initial point, or when it fails the middle of the box, then points
// spread over it; empty when none answers or the evaluator halts.
std::optional<VectorX> find_start(MatchEvaluator& evaluator) {
  VectorX x = evaluator.start();
  for (int index = 0; index <= kProbes; ++index) {
    if (index > 0) {
      x = probe_point(evaluator, index);
    }
    const ResidualAnswer* answer = evaluator.evaluate(
        x, index == 0 ? EvaluationPhase::Start : EvaluationPhase::Probe);
    if (answer == nullptr) {
      return std::nullopt;
    }
    if (!answer->failure) {
      return x;
    }
  }
  return std::nullopt;
}

std::string bounds_reached(const MatchEvaluator& evaluator) {
  std::string text;
  for (Eigen::Index i = 0; i < evaluator.size(); ++i) {
    const Variable& variable =
        evaluator.variables()[static_cast<std::size_t>(i)];
    const double x = evaluator.best()[i];
    const double near = kAtBound * evaluator.ranges()[i];
    const bool low = x <= variable.lower + near;
    if (low || x >= variable.upper - near) {
      text += fmt::format("{}{} at its {} bound {}", text.empty() ? "" : ", ",
                          variable.name, low ? "lower" : "upper",
                          low ? variable.lower : variable.upper);
    }
  }
  return text;
}

std::string failures(const MatchEvaluator& evaluator) {
  if (evaluator.failed_evaluations() == 0) {
    return "";
  }
  return fmt::format(", {} of which could not be evaluated (last: {}: {})",
                     evaluator.failed_evaluations(),
                     name_of(evaluator.last_failure().kind),
                     evaluator.last_failure().message);
}

void conclude_without_point(const MatchEvaluator& evaluator,
                            MatchReport& report) {
  report.termination = Termination::NoFeasible;
  report.message = fmt::format(
      "no design could be evaluated: the initial point {} and {} others "
      "failed, the last with {}: {}. Change what this message names, start "
      "from an initial point known to work, or move the bounds",
      evaluator.describe(evaluator.start()), evaluator.evaluations() - 1,
      name_of(evaluator.last_failure().kind), evaluator.last_failure().message);
}

void conclude_stalled(const MatchEvaluator& evaluator,
                      const std::string& figures, const BackendResult& backend,
                      MatchReport& report) {
  report.termination = Termination::Stalled;
  const std::string bounds = bounds_reached(evaluator);
  const bool flat =
      (backend.jacobian.size() > 0 && backend.jacobian.isZero(0.0) &&
       evaluator.failed_evaluations() == 0) ||
      (evaluator.evaluations() - evaluator.failed_evaluations() > 1 &&
       evaluator.all_answers_equal());
  if (flat) {
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

void conclude(const MatchEvaluator& evaluator, const BackendResult& backend,
              MatchReport& report) {
  if (!evaluator.has_best()) {
    conclude_without_point(evaluator, report);
    return;
  }
  report.best = evaluator.best();
  report.answer = evaluator.best_answer();
  report.cost = cost_of(report.answer);
  const std::string figures = fmt::format(
      "largest mismatch {:.3g} against a tolerance of {:.3g} at {} after {} "
      "evaluations{}",
      worst_mismatch(report.answer), evaluator.options().tolerance,
      evaluator.describe(report.best), evaluator.evaluations(),
      failures(evaluator));
  switch (evaluator.halt()) {
    case MatchEvaluator::Halt::Converged:
      report.termination = Termination::Converged;
      report.message = "matched: " + figures;
      break;
    case MatchEvaluator::Halt::Evaluations:
      report.termination = Termination::LimitReached;
      report.message =
          fmt::format("stopped at the limit of {} evaluations: {}",
                      evaluator.options().max_evaluations, figures);
      break;
    case MatchEvaluator::Halt::Time:
      report.termination = Termination::LimitReached;
      report.message = fmt::format("stopped at the time limit of {} s: {}",
                                   evaluator.options().time_limit, figures);
      break;
    default:
      conclude_stalled(evaluator, figures, backend, report);
  }
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
  MatchEvaluator evaluator(variables, function, options);
  BackendResult backend;
  const std::optional<VectorX> start = find_start(evaluator);
  if (start) {
    backend = options.method == kCeres
                  ? ceres_match(evaluator, *start)
                  : nlopt_match(evaluator, *start, options.method);
  }
  evaluator.rethrow();
  MatchReport report;
  report.evaluations = evaluator.evaluations();
  report.failed_evaluations = evaluator.failed_evaluations();
  report.iterations = backend.iterations;
  report.jacobian = std::move(backend.jacobian);
  conclude(evaluator, backend, report);
  return report;
}

std::vector<std::string> match_methods() {
  std::vector<std::string> names = {kCeres};
  const std::vector<std::string>& nlopt = nlopt_match_methods();
  names.insert(names.end(), nlopt.begin(), nlopt.end());
  return names;
}

}  // namespace meniscus
