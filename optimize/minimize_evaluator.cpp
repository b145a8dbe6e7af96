#include "optimize/minimize_evaluator.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimize/differences.h"

namespace meniscus::optimize {
namespace {

// An objective that had the same bits at this many feasible points, and two
// more per variable, is taken as constant.
constexpr int kConstantAnswers = 10;
// A point that meets the conditions is the answer unless a feasible one is
// better by more than this x the optimality tolerance x scale: then the
// function jumps, or it is another minimum's neighbour.
constexpr double kBetter = 10.0;

void check_positive(const char* name, double value) {
  if (!(value > 0.0)) {
    throw InvalidInput(
        fmt::format("minimize: {} is {}, must be positive", name, value));
  }
}

void check_constraint(const ResponseBounds& constraint) {
  const bool open =
      std::isinf(constraint.lower) && std::isinf(constraint.upper);
  if (!(constraint.lower <= constraint.upper)) {
    throw InvalidInput(fmt::format(
        "minimize: constraint '{}': lower bound {} is above the upper bound "
        "{}; swap them",
        constraint.name, constraint.lower, constraint.upper));
  }
  if (open && constraint.lower == constraint.upper) {
    throw InvalidInput(
        fmt::format("minimize: constraint '{}': both bounds are {}",
                    constraint.name, constraint.lower));
  }
  if (constraint.scale && !(*constraint.scale > 0.0)) {
    throw InvalidInput(
        fmt::format("minimize: constraint '{}': scale is {}, must be positive",
                    constraint.name, *constraint.scale));
  }
}

EvaluationLimits minimize_limits(const MinimizeProblem& problem,
                                 const MinimizeOptions& options) {
  check_positive("optimality_tolerance", options.optimality_tolerance);
  check_positive("feasibility_tolerance", options.feasibility_tolerance);
  check_positive("step_tolerance", options.step_tolerance);
  for (const ResponseBounds& constraint : problem.constraints) {
    check_constraint(constraint);
  }
  return {.study = "minimize",
          .max_evaluations = options.max_evaluations,
          .time_limit = options.time_limit,
          .difference_step = options.difference_step,
          .monitor = options.monitor,
          .announce = options.announce,
          .prefetch = options.prefetch};
}

double finite_magnitude(double bound) {
  return std::isfinite(bound) ? std::abs(bound) : 0.0;
}

}  // namespace

MinimizeEvaluator::MinimizeEvaluator(const MinimizeProblem& problem,
                                     const MinimizeOptions& options)
    : EvaluatorCore(problem.variables, minimize_limits(problem, options)),
      problem_(problem),
      options_(options) {
  make_sides({}, nullptr);
}

const MinimizePoint* MinimizeEvaluator::evaluate(
    const VectorX& x, EvaluationPhase phase) noexcept {
  return guarded([&] { return ask(x, phase); });
}

const MinimizePoint* MinimizeEvaluator::linearise(const VectorX& x) noexcept {
  return guarded([&] { return ask_jacobian(x); });
}

const MinimizePoint* MinimizeEvaluator::ask(const VectorX& x,
                                            EvaluationPhase phase) {
  const VectorX inner = inside(x);
  if (const MinimizePoint* known = memory_.find(inner)) {
    return known;
  }
  if (!begin(phase)) {
    return nullptr;
  }
  VectorAnswer answer = problem_.function(inner);
  MinimizePoint point{.values = std::move(answer.values),
                      .jacobian = {},
                      .failure = std::move(answer.failure)};
  check(point);
  const MinimizePoint& kept = memory_.keep(inner, std::move(point));
  account(inner, kept);
  return halted() ? nullptr : &kept;
}

const MinimizePoint* MinimizeEvaluator::ask_jacobian(const VectorX& x) {
  const VectorX inner = inside(x);
  MinimizePoint* point = memory_.find(inner);
  if (point == nullptr || point->failure ||
      (!point->jacobian && !differentiate(inner, *point))) {
    return nullptr;
  }
  // Where nothing moves the objective the search has not begun: the caller
  // looks elsewhere before it believes a gradient of exactly zero.
  const bool flat = point->jacobian->row(0).isZero(0.0) && !varies_;
  const double better =
      kBetter * options_.optimality_tolerance * objective_scale();
  const bool least =
      !best_is_feasible() || point->values[0] <= best_objective_ + better;
  if (scaled_ && !flat && least && keeps_all(point->values) &&
      conditions(inner, *point).residual <= options_.optimality_tolerance) {
    // One that is better by less is the answer where it meets them too.
    const MinimizePoint& best = best_point();
    if (!best.jacobian ||
        conditions(best_x_, best).residual > options_.optimality_tolerance) {
      make_incumbent(inner, point->values);
    }
    set_halt(Halt::Converged);
    return nullptr;
  }
  return point;
}

bool MinimizeEvaluator::differentiate(const VectorX& x, MinimizePoint& point) {
  if (problem_.jacobian) {
    if (!begin(EvaluationPhase::Gradient)) {
      return false;
    }
    JacobianAnswer answer = problem_.jacobian(x);
    if (!answer.failure && (answer.jacobian.rows() != point.values.size() ||
                            answer.jacobian.cols() != size())) {
      throw InvalidInput(fmt::format(
          "minimize: the Jacobian is {} x {}; expected {} values x {} "
          "variables",
          answer.jacobian.rows(), answer.jacobian.cols(), point.values.size(),
          size()));
    }
    if (!answer.failure && answer.jacobian.allFinite()) {
      point.jacobian = std::move(answer.jacobian);
      return true;
    }
  }
  point.jacobian = one_sided_differences(
      *this, x, point.values, [this](const VectorX& at) -> Neighbour {
        const MinimizePoint* found = evaluate(at, EvaluationPhase::Difference);
        if (found == nullptr) {
          return {.halted = true};
        }
        return {.values = found->failure ? nullptr : &found->values};
      });
  return point.jacobian.has_value();
}

void MinimizeEvaluator::check(MinimizePoint& point) const {
  if (point.failure) {
    return;
  }
  const std::size_t expected = 1 + problem_.constraints.size();
  if (static_cast<std::size_t>(point.values.size()) != expected) {
    throw InvalidInput(fmt::format(
        "minimize: the function answers with {} values; expected {}, the "
        "objective and {} constraints",
        point.values.size(), expected, expected - 1));
  }
  for (std::size_t i = 0; i < expected; ++i) {
    const double value = point.values[static_cast<Eigen::Index>(i)];
    if (!std::isfinite(value)) {
      const std::string& name =
          i == 0 ? problem_.objective : problem_.constraints[i - 1].name;
      point = {};
      point.failure = Failure{
          FailureKind::NotANumber,
          fmt::format("'{}' is {}; look in its expression for a division by "
                      "zero, or a root or logarithm of a negative number",
                      name, value)};
      return;
    }
  }
}

void MinimizeEvaluator::account(const VectorX& x, const MinimizePoint& point) {
  if (point.failure) {
    count_failure(x, *point.failure);
    return;
  }
  const double objective = point.values[0];
  const double off = violation(point.values);
  if (!has_best()) {
    worst_objective_ = objective;
  }
  varies_ = varies_ || (has_best() && objective != worst_objective_);
  worst_objective_ = std::max(worst_objective_, objective);
  worst_violation_ = std::max(worst_violation_, off);
  const bool kept = off <= options_.feasibility_tolerance;
  const bool better =
      !has_best() || (kept && !best_is_feasible()) ||
      (kept ? kept_objective(objective, off) <
                  kept_objective(best_objective_, best_violation_)
            : !best_is_feasible() && off < best_violation_);
  if (better) {
    make_incumbent(x, point.values);
  }
  report_progress(fmt::format(
      "{}, {}{}, best {}{}", describe(x), problem_.objective_text(objective),
      kept ? "" : fmt::format(" (violation {:.2g})", off),
      problem_.objective_text(best_objective_),
      best_is_feasible() ? "" : " (infeasible)"));
  if (!varies_ && best_is_feasible() &&
      answered() >= kConstantAnswers + 2 * static_cast<int>(size())) {
    set_halt(Halt::Constant);
  }
}

void MinimizeEvaluator::make_incumbent(const VectorX& x,
                                       const VectorX& values) {
  best_x_ = x;
  best_objective_ = values[0];
  best_violation_ = violation(values);
}

void MinimizeEvaluator::fix_scales(const VectorX& start,
                                   const Eigen::MatrixXd* derivatives) {
  const VectorX& values = memory_.find(inside(start))->values;
  start_objective_ = values[0];
  double unit = std::abs(values[0]);
  if (derivatives != nullptr) {
    const double steepest = derivatives->row(0)
                                .transpose()
                                .cwiseProduct(ranges())
                                .cwiseAbs()
                                .maxCoeff();
    unit = steepest > 0.0 ? steepest : unit;
  }
  objective_unit_ = unit > 0.0 ? unit : 1.0;
  make_sides(values, derivatives);
  make_incumbent(best_x_, memory_.find(best_x_)->values);
  worst_violation_ = best_violation_;
  scaled_ = true;
}

void MinimizeEvaluator::make_sides(const VectorX& start,
                                   const Eigen::MatrixXd* derivatives) {
  sides_.clear();
  const std::vector<ResponseBounds>& all = problem_.constraints;
  constraint_scale_ = VectorX::Ones(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i) + 1;
    double scale = std::max(finite_magnitude(all[i].lower),
                            finite_magnitude(all[i].upper));
    if (scale == 0.0 && start.size() > 0) {
      scale = std::abs(start[row]);
      if (derivatives != nullptr) {
        scale = std::max(scale, derivatives->row(row)
                                    .transpose()
                                    .cwiseProduct(ranges())
                                    .cwiseAbs()
                                    .maxCoeff());
      }
    }
    scale = all[i].scale.value_or(scale > 0.0 ? scale : 1.0);
    constraint_scale_[row - 1] = scale;
    const bool equation = all[i].lower == all[i].upper;
    if (std::isfinite(all[i].upper)) {
      sides_.push_back({row, 1.0, all[i].upper, scale, equation,
                        all[i].root_like && all[i].upper != 0.0});
    }
    if (std::isfinite(all[i].lower) && !equation) {
      sides_.push_back({row, -1.0, all[i].lower, scale, false,
                        all[i].root_like && all[i].lower != 0.0});
    }
  }
}

double MinimizeEvaluator::objective_scale() const {
  return std::max(std::abs(start_objective_), std::abs(best_objective_));
}

double MinimizeEvaluator::violation(const VectorX& values) const {
  double worst = 0.0;
  for (const ConstraintSide& side : sides_) {
    const double value = side.value(values);
    worst = std::max(worst, side.equation ? std::abs(value) : value);
  }
  return worst;
}

FirstOrderReport MinimizeEvaluator::conditions(const VectorX& x,
                                               const MinimizePoint& point,
                                               const VectorX& low,
                                               const VectorX& high,
                                               const VectorX& units) const {
  const auto count = static_cast<Eigen::Index>(problem_.constraints.size());
  FirstOrderInput input{.x = x,
                        .lower = low,
                        .upper = high,
                        .ranges = units,
                        .values = point.values,
                        .jacobian = *point.jacobian,
                        .constraint_lower = VectorX(count),
                        .constraint_upper = VectorX(count),
                        .constraint_scale = constraint_scale_,
                        .objective_scale = objective_scale()};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& constraint = problem_.constraints[static_cast<std::size_t>(i)];
    input.constraint_lower[i] = constraint.lower;
    input.constraint_upper[i] = constraint.upper;
  }
  return first_order(input);
}

}  // namespace meniscus::optimize
