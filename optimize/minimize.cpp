#include "optimize/minimize.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "optimize/first_start.h"
#include "optimize/free_variables.h"
#include "optimize/minimize_report.h"
#include "optimize/minimize_search.h"
#include "optimize/nlopt_minimize.h"

namespace meniscus::optimize {
namespace {

constexpr const char* kStudy = "minimize";
// Where the gradient is exactly zero, these points tell a constant objective
// from a start at its minimum; the first probe is the middle of the box, where
// many cases start.
constexpr int kFirstProbe = 2;
constexpr int kLastProbe = 4;

void check_minimize_method(const std::string& name) {
  if (find_minimize_method(name) != nullptr) {
    return;
  }
  std::vector<std::string> names;
  for (const MinimizeMethod& method : minimize_methods()) {
    names.push_back(method.name);
  }
  throw InvalidInput(
      fmt::format("minimize: method '{}' is not known; there are {}", name,
                  fmt::join(names, ", ")));
}

std::optional<VectorX> minimum_start(MinimizeEvaluator& evaluator) {
  return find_start(
      evaluator,
      [&](const VectorX& x, EvaluationPhase phase) -> std::optional<bool> {
        const MinimizePoint* point = evaluator.evaluate(x, phase);
        if (point == nullptr) {
          return std::nullopt;
        }
        return !point->failure;
      });
}

// True when no probe changes the objective, one at least having been evaluated;
// a better one becomes the incumbent by itself.
bool is_constant(MinimizeEvaluator& evaluator) {
  for (int index = kFirstProbe; index <= kLastProbe; ++index) {
    if (evaluator.objective_varies() || evaluator.halted()) {
      break;
    }
    evaluator.evaluate(probe_point(evaluator, index), EvaluationPhase::Probe);
  }
  return !evaluator.objective_varies() && evaluator.best_is_feasible() &&
         evaluator.evaluations() - evaluator.failed_evaluations() > 1;
}

SearchResult search_from(MinimizeEvaluator& evaluator, const VectorX& start,
                         const MinimizeMethod& method) {
  const MinimizePoint* point =
      method.gradients ? evaluator.linearise(start) : nullptr;
  evaluator.fix_scales(start, point == nullptr ? nullptr : &*point->jacobian);
  if (method.gradients) {
    evaluator.linearise(start);  // it may be a minimum by these scales
  }
  return evaluator.halted() ? SearchResult{}
                            : search(evaluator, start, method.name);
}

MinimizeReport minimize_all(const MinimizeProblem& problem,
                            const MinimizeOptions& options) {
  const MinimizeMethod& method = *find_minimize_method(options.method);
  MinimizeEvaluator evaluator(problem, options);
  SearchResult found;
  bool constant = false;
  if (const std::optional<VectorX> start = minimum_start(evaluator)) {
    found = search_from(evaluator, *start, method);
    if (!evaluator.halted() && !evaluator.objective_varies()) {
      constant = is_constant(evaluator);
      if (!constant && !evaluator.halted()) {
        found = search(evaluator, evaluator.best(), method.name);
      }
    }
    const bool derivatives = method.gradients || problem.jacobian;
    if (!constant && derivatives && !evaluator.halted()) {
      evaluator.linearise(evaluator.best());
    }
  }
  evaluator.rethrow();
  return finish_report(evaluator, found, constant);
}

// No variable moves: one evaluation says what there is.
MinimizeReport minimize_held(const MinimizeProblem& problem,
                             const MinimizeOptions& options,
                             const FreeVariables& free) {
  MinimizeEvaluator evaluator(problem, options);
  evaluator.evaluate(evaluator.start(), EvaluationPhase::Start);
  evaluator.rethrow();
  MinimizeReport report = finish_report(evaluator, {}, false);
  if (report.termination != Termination::NoFeasible) {
    report.termination = Termination::NoFreedom;
    report.message = free.held_message();
  }
  return report;
}

// Some variables are held: the search sees the others.
MinimizeReport minimize_free(const MinimizeProblem& problem,
                             const MinimizeOptions& options,
                             const FreeVariables& free) {
  MinimizeProblem inner = problem;
  MinimizeOptions inner_options = options;
  inner.variables = free.free();
  inner.function = [&](const VectorX& x) {
    return problem.function(free.expanded(x));
  };
  if (problem.jacobian) {
    inner.jacobian = [&](const VectorX& x) {
      JacobianAnswer answer = problem.jacobian(free.expanded(x));
      answer.jacobian = free.reduced(answer.jacobian);
      return answer;
    };
  }
  if (options.prefetch) {
    inner_options.prefetch = [&](const std::vector<VectorX>& points) {
      options.prefetch(free.expanded(points));
    };
  }
  MinimizeReport report = minimize_all(inner, inner_options);
  if (report.best.size() > 0) {
    report.best = free.expanded(report.best);
  }
  report.jacobian = free.widened(report.jacobian);
  if (report.first_order) {
    VectorX& multipliers = report.first_order->bound_multipliers;
    multipliers = free.widened(multipliers.transpose()).transpose();
  }
  return report;
}

}  // namespace

std::string MinimizeProblem::objective_text(double value) const {
  return objective + ' ' + shown.text(value);
}

const std::vector<MinimizeMethod>& minimize_methods() {
  static const std::vector<MinimizeMethod> methods = [] {
    std::vector<MinimizeMethod> list;
    for (const NloptTraits& traits : nlopt_traits()) {
      list.push_back(traits.method);
    }
    return list;
  }();
  return methods;
}

double kept_objective(double objective, double violation) {
  constexpr double kPrice = 10.0;
  return objective + kPrice * std::abs(objective) * std::max(violation, 0.0);
}

const MinimizeMethod* find_minimize_method(const std::string& name) {
  const std::vector<MinimizeMethod>& all = minimize_methods();
  const auto at = std::find_if(
      all.begin(), all.end(),
      [&](const MinimizeMethod& method) { return method.name == name; });
  return at == all.end() ? nullptr : &*at;
}

MinimizeReport minimize(const MinimizeProblem& problem,
                        const MinimizeOptions& options) {
  check_minimize_method(options.method);
  check_variables(problem.variables, kStudy);
  const FreeVariables free(problem.variables);
  if (free.all_held()) {
    return minimize_held(problem, options, free);
  }
  return free.any_held() ? minimize_free(problem, options, free)
                         : minimize_all(problem, options);
}

}  // namespace meniscus::optimize
