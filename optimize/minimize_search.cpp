#include "optimize/minimize_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "optimize/nlopt_minimize.h"
#include "optimize/trust_region.h"

namespace meniscus::optimize {
namespace {

// Part of the evaluations that a global method may spend before its best point
// is polished by a local one.
constexpr double kGlobalPart = 0.75;
// What counts as a gain between two runs, x the objective's scale, or as part
// of the violation. Near a minimum the objective errs by the square of the
// first-order residual.
constexpr double kGain = 1e-12;
constexpr double kWalledGain = 1e-3;  // creeping along a wall is not worth it
constexpr double kViolationGain = 0.01;
// A run that did not help, or met points that fail, is followed by one in a
// box this much smaller, down to the smallest.
constexpr double kShrink = 0.25;
constexpr double kSmallestRadius = 1e-4;
// One that was used up is followed by one about its end, this much wider.
constexpr double kWiden = 2.0;
constexpr int kMostRuns = 40;
// The first step of a method that has to choose one, x its box; in later
// minimisations of an augmented Lagrangian, x the tolerance.
constexpr double kFirstStep = 0.1;
constexpr double kWarmStep = 30.0;
// Augmented Lagrangian (E. G. Birgin, J. M. Martinez, Practical Augmented
// Lagrangian Methods, 2014): the violation has to fall to a part, or rho grows.
constexpr double kFirstRho = 10.0;
constexpr double kFallen = 0.5;
constexpr double kGrowth = 10.0;
constexpr double kLargestRho = 1e7;
constexpr int kMostOuter = 40;
constexpr double kFirstTolerance = 1e-2;
constexpr double kRestartRho = 1e4;
// Steps as fine as the constraints are kept are fine enough.
constexpr double kStepsPerViolation = 0.1;
// Steep constraints may need finer steps than those asked for.
constexpr double kFinerSteps = 1e-3;

// Of methods of convex approximations: what constraints may be missed by, step
// by step [scales], the gain that ends a step as part of that, and the first
// box.
constexpr std::array<double, 4> kLoose = {1e-2, 1e-3, 1e-5, 0.0};
constexpr double kGainPart = 1.0;
constexpr double kFirstTrustRadius = 0.25;
// Of later runs of the trust region, and the gain that asks for one.
constexpr double kRestartRadius = 0.05;
constexpr double kRestartGain = 1e-5;
constexpr int kMostTurns = 8;

struct Tightening {
  std::size_t step = 0;
};

constexpr const char* kFeeler = "cobyla";

const NloptTraits& traits_of(const std::string& name) {
  for (const NloptTraits& traits : nlopt_traits()) {
    if (traits.method.name == name) {
      return traits;
    }
  }
  throw InvalidInput("minimize: method '" + name + "' is not known");
}

bool uses_lagrangian(const MinimizeEvaluator& evaluator,
                     const NloptTraits& traits) {
  return std::any_of(
      evaluator.sides().begin(), evaluator.sides().end(),
      [&](const ConstraintSide& side) { return in_lagrangian(traits, side); });
}

// New multipliers at `values`; returns the largest violation of feasibility
// or complementarity among the sides in the Lagrangian.
double update(const MinimizeEvaluator& evaluator, const NloptTraits& traits,
              const VectorX& values, NloptTask& task) {
  double worst = 0.0;
  for (std::size_t k = 0; k < evaluator.sides().size(); ++k) {
    const ConstraintSide& side = evaluator.sides()[k];
    if (!in_lagrangian(traits, side)) {
      continue;
    }
    double& m = task.multipliers[static_cast<Eigen::Index>(k)];
    const double g = side.value(values);
    worst = std::max(worst,
                     std::abs(side.equation ? g : std::max(g, -m / task.rho)));
    m += task.rho * g;
    m = side.equation ? m : std::max(m, 0.0);
  }
  return worst;
}

// Leaves its multipliers and rho in the task.
NloptResult run_lagrangian(MinimizeEvaluator& evaluator,
                           const NloptTraits& traits, NloptTask& task) {
  const double finest = evaluator.options().step_tolerance;
  const double target = 0.5 * evaluator.options().feasibility_tolerance;
  double before = std::numeric_limits<double>::infinity();
  // Multipliers of an earlier run are near: what is left is precision.
  double tolerance = task.multipliers.isZero(0.0)
                         ? std::max(finest, kFirstTolerance)
                         : kFinerSteps * finest;
  task.rho = std::min(task.rho, kRestartRho);
  NloptResult result;
  for (int outer = 0; outer < kMostOuter; ++outer) {
    task.step_tolerance = tolerance;
    task.first_step =
        outer == 0 ? kFirstStep : std::min(kFirstStep, kWarmStep * tolerance);
    const int iterations = result.iterations;
    result = run_nlopt(evaluator, traits, task);
    result.iterations += iterations;
    if (evaluator.halted()) {
      return result;
    }
    const MinimizePoint* point =
        evaluator.evaluate(result.x, EvaluationPhase::Step);
    if (point == nullptr || point->failure) {
      break;
    }
    task.start = result.x;
    const double worst = update(evaluator, traits, point->values, task);
    if (worst <= target && tolerance <= finest) {
      return result;
    }
    if (worst > std::max(target, kFallen * before)) {
      task.rho *= kGrowth;
    }
    if (task.rho > kLargestRho) {
      break;  // it cannot be kept here
    }
    before = worst;
    tolerance =
        std::clamp(kStepsPerViolation * worst, kFinerSteps * finest, tolerance);
  }
  result.finished = false;
  return result;
}

// An equation as the side of it that the start misses; at a minimum it holds
// the objective up from one side, too.
void choose_sides(MinimizeEvaluator& evaluator, NloptTask& task) {
  const std::vector<ConstraintSide>& sides = evaluator.sides();
  const MinimizePoint* point =
      evaluator.evaluate(task.start, EvaluationPhase::Step);
  task.one_sided = VectorX::Zero(static_cast<Eigen::Index>(sides.size()));
  for (std::size_t k = 0; point != nullptr && k < sides.size(); ++k) {
    if (sides[k].equation) {
      task.one_sided[static_cast<Eigen::Index>(k)] =
          sides[k].value(point->values) < 0.0 ? -1.0 : 1.0;
    }
  }
}

// Turns the equations that are missed on their free side; false when none is.
bool turn_sides(const MinimizeEvaluator& evaluator, const VectorX& values,
                NloptTask& task) {
  bool turned = false;
  for (std::size_t k = 0; k < evaluator.sides().size(); ++k) {
    double& sign = task.one_sided[static_cast<Eigen::Index>(k)];
    if (sign * evaluator.sides()[k].value(values) <
        -std::max(task.loose, evaluator.options().feasibility_tolerance)) {
      sign = -sign;
      turned = true;
    }
  }
  return turned;
}

// Methods of convex approximations ask that these be no less than the
// constraints themselves before they step; missed by little, steps are long.
NloptResult run_tightening(MinimizeEvaluator& evaluator,
                           const NloptTraits& traits, NloptTask& task,
                           Tightening& state) {
  NloptResult result;
  int turns = 0;
  while (true) {
    task.loose = kLoose[state.step];
    task.least_gain = kGainPart * task.loose;
    const int iterations = result.iterations;
    result = run_nlopt(evaluator, traits, task);
    result.iterations += iterations;
    if (evaluator.halted() || !result.finished) {
      return result;
    }
    const MinimizePoint* point =
        evaluator.evaluate(result.x, EvaluationPhase::Step);
    if (point == nullptr || point->failure) {
      return result;
    }
    task.start = result.x;
    if (turn_sides(evaluator, point->values, task) && ++turns <= kMostTurns) {
      continue;
    }
    if (state.step + 1 == kLoose.size()) {
      return result;
    }
    ++state.step;
  }
}

NloptResult run(MinimizeEvaluator& evaluator, const NloptTraits& traits,
                NloptTask& task, Tightening& state) {
  if (traits.style == ConstraintStyle::NativeInequalities) {
    return run_tightening(evaluator, traits, task, state);
  }
  task.step_tolerance = evaluator.options().step_tolerance;
  task.first_step = kFirstStep;
  return uses_lagrangian(evaluator, traits)
             ? run_lagrangian(evaluator, traits, task)
             : run_nlopt(evaluator, traits, task);
}

NloptTask first_task(const MinimizeEvaluator& evaluator, const VectorX& start) {
  return {.start = start,
          .radius = 1.0,
          .rho = kFirstRho,
          .multipliers = VectorX::Zero(
              static_cast<Eigen::Index>(evaluator.sides().size()))};
}

struct Merit {
  bool feasible = false;
  double violation = 0.0;
  double objective = 0.0;
  int failed = 0;
};

Merit merit_of(const MinimizeEvaluator& evaluator) {
  return {evaluator.best_is_feasible(), evaluator.best_violation(),
          evaluator.best_objective(), evaluator.failed_evaluations()};
}

bool gained(const Merit& before, const Merit& after, double least) {
  if (after.feasible != before.feasible) {
    return true;
  }
  return after.feasible
             ? after.objective < before.objective - least
             : after.violation < (1.0 - kViolationGain) * before.violation;
}

// Where the last box was used up: a start for the next, though it may miss
// constraints by a little.
struct BoxEnd {
  VectorX x;
  double objective = std::numeric_limits<double>::infinity();
  double violation = 0.0;

  // True when `last` ended at a box better than the one before.
  bool reach(MinimizeEvaluator& evaluator, const NloptResult& last,
             double least) {
    if (!last.box_used_up) {
      return false;
    }
    const double before = objective;
    const MinimizePoint* point =
        evaluator.evaluate(last.x, EvaluationPhase::Step);
    x = last.x;
    objective = point->values[0];
    violation = evaluator.violation(point->values);
    return objective < before - least;
  }

  bool leads(const MinimizeEvaluator& evaluator) const {
    return x.size() > 0 && (objective < evaluator.best_objective() ||
                            violation <= evaluator.best_violation());
  }
};

double next_radius(double radius, const NloptResult& last, bool walled,
                   bool gain) {
  if (last.box_used_up && gain) {
    return walled ? radius : std::min(1.0, kWiden * radius);
  }
  return walled || !gain ? kShrink * radius : std::min(1.0, radius / kShrink);
}

SearchResult trust_region_search(MinimizeEvaluator& evaluator,
                                 const VectorX& start);

SearchResult local_search(MinimizeEvaluator& evaluator, const VectorX& start,
                          const NloptTraits& traits) {
  if (traits.style == ConstraintStyle::TrustRegion) {
    return trust_region_search(evaluator, start);
  }
  SearchResult result;
  NloptTask task = first_task(evaluator, start);
  Tightening tightening;
  if (traits.style == ConstraintStyle::NativeInequalities) {
    choose_sides(evaluator, task);
    task.radius = kFirstTrustRadius;
  }
  BoxEnd box;
  int idle = 0;
  for (int round = 0; round < kMostRuns; ++round) {
    const Merit before = merit_of(evaluator);
    const NloptResult last = run(evaluator, traits, task, tightening);
    result.iterations += last.iterations;
    result.finished = last.finished;
    result.message = last.message;
    if (evaluator.halted()) {
      break;
    }
    const Merit after = merit_of(evaluator);
    const double scale =
        std::max(evaluator.objective_scale(), evaluator.objective_unit());
    result.walled = after.failed > before.failed;
    const double least = (result.walled ? kWalledGain : kGain) * scale;
    const bool gain =
        box.reach(evaluator, last, least) || gained(before, after, least);
    // Without derivatives a run that ended by itself is the answer, unless its
    // model was spoilt by points that fail.
    const bool restarts =
        traits.restarts && !uses_lagrangian(evaluator, traits);
    const bool again =
        traits.method.gradients || restarts || result.walled || !last.finished;
    idle = gain ? 0 : idle + 1;
    if (!again || idle > 2 || (idle > 1 && !result.walled)) {
      break;
    }
    task.radius = next_radius(task.radius, last, result.walled, gain);
    if (task.radius < kSmallestRadius) {
      break;
    }
    task.start = box.leads(evaluator) ? box.x : evaluator.best();
  }
  return result;
}

// Runs of the trust region, each from the best design so far without what the
// one before learnt of the function, until one gains nothing.
SearchResult trust_region_search(MinimizeEvaluator& evaluator,
                                 const VectorX& start) {
  SearchResult result;
  VectorX from = start;
  double radius = kFirstTrustRadius;
  for (int round = 0; round < kMostRuns; ++round) {
    const Merit before = merit_of(evaluator);
    const SearchResult last = trust_region_run(evaluator, from, radius);
    result.iterations += last.iterations;
    result.finished = last.finished;
    result.walled = last.walled;
    result.message = last.message;
    if (evaluator.halted()) {
      break;
    }
    const double scale =
        std::max(evaluator.objective_scale(), evaluator.objective_unit());
    if (!gained(before, merit_of(evaluator),
                (last.walled ? kWalledGain : kRestartGain) * scale)) {
      break;
    }
    from = evaluator.best();
    radius = kRestartRadius;
  }
  return result;
}

}  // namespace

SearchResult search(MinimizeEvaluator& evaluator, const VectorX& start,
                    const std::string& method) {
  const NloptTraits& traits = traits_of(method);
  if (!traits.method.global) {
    SearchResult result = local_search(evaluator, start, traits);
    if (traits.method.gradients && result.walled && !evaluator.halted()) {
      // A simplex feels its way along a wall that a gradient does not know.
      const SearchResult more =
          local_search(evaluator, evaluator.best(), traits_of(kFeeler));
      result.iterations += more.iterations;
      result.message = more.message;
    }
    return result;
  }
  const int used = evaluator.evaluations();
  evaluator.begin_stage(
      used + static_cast<int>(kGlobalPart * evaluator.evaluations_left()));
  NloptTask task = first_task(evaluator, start);
  Tightening tightening;
  const NloptResult wide = run(evaluator, traits, task, tightening);
  evaluator.end_stage();
  if (evaluator.halted()) {
    return {.iterations = wide.iterations, .message = wide.message};
  }
  const std::string polish = evaluator.problem().jacobian ? "slsqp" : "cobyla";
  SearchResult result =
      local_search(evaluator, evaluator.best(), traits_of(polish));
  result.iterations += wide.iterations;
  return result;
}

}  // namespace meniscus::optimize
