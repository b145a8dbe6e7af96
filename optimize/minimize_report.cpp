#include "optimize/minimize_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimize/first_start.h"
#include "optimize/nlopt_minimize.h"

namespace meniscus::optimize {
namespace {

// So many missed constraints are named.
constexpr std::size_t kNamed = 3;
// A kept constraint this close to its bound, in scales, stands in the way.
constexpr double kInTheWay = 1e-3;
// A search by gradients whose steps came to nothing is at a minimum as far as
// the function lets it see where the residual is below this x the tolerance.
constexpr double kNearlyStationary = 30.0;

constexpr const char* kWalled =
    "It stands beside designs that cannot be evaluated: add a constraint (a "
    "margin to collapse) or a bound that keeps away from them";

bool uses_gradients(const std::string& name) {
  const MinimizeMethod* method = find_minimize_method(name);
  return method != nullptr && method->gradients;
}

void fill_constraints(const MinimizeEvaluator& evaluator,
                      MinimizeReport& report) {
  const auto& constraints = evaluator.problem().constraints;
  report.constraints.reserve(constraints.size());
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    ConstraintState state{.name = constraints[i].name,
                          .shown = constraints[i].shown,
                          .value = report.values[row + 1],
                          .lower = constraints[i].lower,
                          .upper = constraints[i].upper};
    for (const ConstraintSide& side : evaluator.sides()) {
      if (side.row == row + 1) {
        const double value = side.value(report.values);
        state.scale = side.scale;
        state.violation =
            std::max(state.violation, side.equation ? std::abs(value) : value);
      }
    }
    state.satisfied =
        state.violation <= evaluator.options().feasibility_tolerance;
    if (report.first_order) {
      state.multiplier = report.first_order->multipliers[row];
    }
    report.constraints.push_back(std::move(state));
  }
}

std::string demand(const ConstraintState& state) {
  if (state.lower == state.upper) {
    return "must be " + state.shown.text(state.upper);
  }
  return state.value > state.upper
             ? "must be at most " + state.shown.text(state.upper)
             : "must be at least " + state.shown.text(state.lower);
}

std::string missed(const MinimizeReport& report) {
  std::vector<ConstraintState> states;
  for (const ConstraintState& state : report.constraints) {
    if (!state.satisfied) {
      states.push_back(state);
    }
  }
  std::stable_sort(states.begin(), states.end(),
                   [](const ConstraintState& a, const ConstraintState& b) {
                     return a.violation > b.violation;
                   });
  std::string text;
  for (std::size_t i = 0; i < std::min(states.size(), kNamed); ++i) {
    text +=
        fmt::format("{}'{}' is {} and {}", i == 0 ? "" : ", ", states[i].name,
                    states[i].shown.text(states[i].value), demand(states[i]));
  }
  if (states.size() > kNamed) {
    text += fmt::format(" and {} more", states.size() - kNamed);
  }
  return text;
}

// The kept constraints that stand at a bound, in words.
std::string in_the_way(const MinimizeEvaluator& evaluator,
                       const MinimizeReport& report) {
  std::string text;
  for (const ConstraintSide& side : evaluator.sides()) {
    const ConstraintState& state =
        report.constraints[static_cast<std::size_t>(side.row) - 1];
    if (state.satisfied && side.value(report.values) > -kInTheWay) {
      text += fmt::format("{}'{}' at its {} bound {}", text.empty() ? "" : ", ",
                          state.name, side.sign > 0.0 ? "upper" : "lower",
                          state.shown.text(side.bound));
    }
  }
  return text;
}

std::string figures(const MinimizeEvaluator& evaluator,
                    const MinimizeReport& report) {
  std::string text =
      fmt::format("{} at {} after {}{}",
                  evaluator.problem().objective_text(report.objective),
                  evaluator.describe(report.best),
                  evaluations_text(report.evaluations,
                                   evaluator.options().earlier_evaluations),
                  evaluator.failures());
  if (report.first_order) {
    text += fmt::format(", first-order residual {:.2g} (asked: {:.2g})",
                        report.first_order->residual,
                        evaluator.options().optimality_tolerance);
  }
  if (!report.feasible) {
    text += "; of the constraints, " + missed(report);
  }
  return text;
}

void set_infeasible(const MinimizeEvaluator& evaluator,
                    const SearchResult& search, MinimizeReport& report) {
  const std::string bounds = evaluator.bounds_reached(report.best);
  std::string stands = in_the_way(evaluator, report);
  stands += (stands.empty() || bounds.empty() ? "" : ", ") + bounds;
  report.termination = Termination::Infeasible;
  report.message = fmt::format(
      "no design was found that keeps every constraint: at the nearest one, "
      "{}, {}{}{}. Loosen one of these, widen the variables' bounds, or free "
      "another variable ({} evaluations{})",
      evaluator.describe(report.best), missed(report),
      stands.empty() ? "" : "; it stands with ", stands, report.evaluations,
      evaluator.failures());
  report.message += search.walled ? std::string(". ") + kWalled : "";
}

void set_constant(const MinimizeEvaluator& evaluator, MinimizeReport& report) {
  report.termination = Termination::Constant;
  report.message = fmt::format(
      "'{}' is {} wherever it was evaluated: no design variable changes "
      "it. Choose another objective, or variables that move this one ({} "
      "evaluations{})",
      evaluator.problem().objective,
      evaluator.problem().shown.text(report.objective), report.evaluations,
      evaluator.failures());
}

void set_ended(const MinimizeEvaluator& evaluator, const SearchResult& search,
               MinimizeReport& report) {
  const bool stationary =
      report.first_order &&
      report.first_order->residual <= evaluator.options().optimality_tolerance;
  const bool nearly =
      !uses_gradients(evaluator.options().method) ||
      (report.first_order &&
       report.first_order->residual <=
           kNearlyStationary * evaluator.options().optimality_tolerance);
  if (stationary || (nearly && search.finished)) {
    report.termination = Termination::Converged;
    report.message = fmt::format(
        "{}: {}", stationary ? "minimum found" : "nothing better found nearby",
        figures(evaluator, report));
    return;
  }
  report.termination = Termination::Stalled;
  report.message = fmt::format(
      "no better design found ({}): {}. {}", search.message,
      figures(evaluator, report),
      search.walled
          ? kWalled
          : "Loosen the tolerance, start elsewhere, or choose another "
            "method");
}

// What to change, before "allow more".
std::string minimum_advice(const MinimizeEvaluator& evaluator,
                           const MinimizeReport& report) {
  if (!report.feasible) {
    return "No design found so far keeps every constraint: loosen one of "
           "these, widen the variables' bounds, or ";
  }
  return 2 * report.failed_evaluations > evaluator.evaluations()
             ? "Most designs within the bounds cannot be evaluated: see why, "
               "tighten the bounds around those that can, or "
             : "Start elsewhere, or ";
}

void set_limit(const MinimizeEvaluator& evaluator, MinimizeReport& report) {
  const bool time = evaluator.halt() == EvaluatorCore::Halt::Time;
  report.termination = Termination::LimitReached;
  report.message = fmt::format(
      "stopped at the {}: {}. {}allow more {}",
      time ? fmt::format("time limit of {} s", evaluator.options().time_limit)
           : limit_text(evaluator.options().max_evaluations,
                        evaluator.options().earlier_evaluations),
      figures(evaluator, report), minimum_advice(evaluator, report),
      time ? "time" : "evaluations");
}

// Slopes from differences that all failed are 0 and prove nothing.
void set_without_constraints(const MinimizeEvaluator& evaluator,
                             MinimizeReport& report) {
  report.termination = Termination::Stalled;
  report.message = fmt::format(
      "of all designs that were tried within the bounds only one can be "
      "evaluated: {}. See why the others cannot, set bounds around designs "
      "that can, or start elsewhere",
      figures(evaluator, report));
}

void decide(const MinimizeEvaluator& evaluator, const SearchResult& search,
            bool constant, MinimizeReport& report) {
  using Halt = EvaluatorCore::Halt;
  if (report.failed_evaluations > 0 &&
      report.evaluations - report.failed_evaluations == 1) {
    set_without_constraints(evaluator, report);
  } else if (constant || evaluator.halt() == Halt::Constant) {
    set_constant(evaluator, report);
  } else if (evaluator.halt() == Halt::Converged) {
    report.termination = Termination::Converged;
    report.message = "minimum found: " + figures(evaluator, report);
  } else if (evaluator.halt() == Halt::Evaluations ||
             evaluator.halt() == Halt::Time) {
    set_limit(evaluator, report);
  } else if (!report.feasible) {
    set_infeasible(evaluator, search, report);
  } else {
    set_ended(evaluator, search, report);
  }
}

}  // namespace

MinimizeReport finish_report(MinimizeEvaluator& evaluator,
                             const SearchResult& search, bool constant) {
  MinimizeReport report;
  report.evaluations = evaluator.evaluations();
  report.failed_evaluations = evaluator.failed_evaluations();
  report.gradient_evaluations = evaluator.gradient_evaluations();
  report.iterations = search.iterations;
  if (!evaluator.has_best()) {
    report.termination = Termination::NoFeasible;
    report.message = no_start_message(evaluator);
    return report;
  }
  report.best = evaluator.best();
  const MinimizePoint& point = evaluator.best_point();
  report.values = point.values;
  report.objective = point.values[0];
  report.feasible = evaluator.best_is_feasible();
  if (point.jacobian) {
    report.jacobian = *point.jacobian;
    report.first_order = evaluator.conditions(report.best, point);
  }
  fill_constraints(evaluator, report);
  decide(evaluator, search, constant, report);
  const std::string note = precision_note(
      evaluator.problem(), report, evaluator.options().optimality_tolerance,
      evaluator.options().value_error);
  report.message += note.empty() ? "" : ". " + note;
  return report;
}

std::string precision_note(const MinimizeProblem& problem,
                           const MinimizeReport& report,
                           double optimality_tolerance,
                           const VectorX& value_error) {
  if (value_error.size() != report.values.size() || report.values.size() == 0) {
    return "";
  }
  std::string note;
  const double asked = optimality_tolerance * std::abs(report.objective);
  if (value_error[0] > asked) {
    note = fmt::format(
        "The tolerance asked for, {:.1e} of '{}', is below the mesh's own "
        "error of it, about {:.1e}",
        optimality_tolerance, problem.objective,
        value_error[0] / std::abs(report.objective));
  }
  for (std::size_t i = 0; i < report.constraints.size(); ++i) {
    const ConstraintState& state = report.constraints[i];
    const double error = value_error[static_cast<Eigen::Index>(i) + 1];
    const double distance = std::min(std::abs(state.value - state.lower),
                                     std::abs(state.value - state.upper));
    if (distance < error) {
      note += fmt::format(
          "{}'{}' stands {} from its bound, nearer than the mesh's own error "
          "of it, about {}",
          note.empty() ? "" : ". ", state.name, state.shown.text(distance, 2),
          state.shown.text(error, 2));
    }
  }
  return note.empty() ? "" : note + ". Shorten the edges to trust more digits";
}

}  // namespace meniscus::optimize
