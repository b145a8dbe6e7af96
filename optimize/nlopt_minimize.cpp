#include "optimize/nlopt_minimize.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlopt.hpp>

#include "optimize/nlopt_vector.h"

namespace meniscus::optimize {
namespace {

// With derivatives the first-order residual ends a search; below these, x
// range and x objective, there is nothing but rounding.
constexpr double kGradientStep = 1e-10;
constexpr double kGradientGain = 1e-14;
// A library that asks only what is known already is stopped by this.
constexpr int kCallsPerEvaluation = 50;
constexpr int kMoreCalls = 1000;
// A constraint counts as kept for the library at this part of our tolerance.
constexpr double kTolerancePart = 0.5;
// After so many more failed points than others a method that steps back is
// stopped: a smaller box finds the way sooner than a line search.
constexpr int kMostFailures = 5;
// A box is left when this part of what the next one promises is left in it.
constexpr double kLeftInBox = 0.1;
// A box is left though constraints are missed by this part of their scales.
constexpr double kMissedInBox = 1e-3;
// A point that fails is this much worse than the worst one of the run, so that
// models of the function are bent as little as can be.
constexpr double kWall = 0.01;
// While a global method looks around, an equation is kept within this.
constexpr double kLooseEquation = 1e-3;

// NLopt sees s_j = x_j / unit_j, the units powers of two: of the size of the
// ranges, and exact both ways.
VectorX units_of(const VectorX& ranges) {
  VectorX units(ranges.size());
  for (Eigen::Index j = 0; j < ranges.size(); ++j) {
    units[j] = std::exp2(std::ceil(std::log2(ranges[j])));
  }
  return units;
}

class Run {
 public:
  Run(MinimizeEvaluator& evaluator, const NloptTraits& traits,
      const NloptTask& task)
      : evaluator_(evaluator),
        traits_(traits),
        task_(task),
        units_(units_of(evaluator.ranges())),
        low_(evaluator.lower().cwiseMax(task.start -
                                        task.radius * evaluator.ranges())),
        high_(evaluator.upper().cwiseMin(task.start +
                                         task.radius * evaluator.ranges())),
        optimizer_(static_cast<nlopt::algorithm>(traits.algorithm),
                   static_cast<unsigned>(evaluator.size())) {
    const std::vector<ConstraintSide>& sides = evaluator.sides();
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (in_lagrangian(traits, sides[k]) && sign_of(k) == 0.0) {
        lagrangian_.push_back(k);
      } else if (traits.style != ConstraintStyle::FeasibleFirst) {
        (sides[k].equation && sign_of(k) == 0.0 ? equations_ : inequalities_)
            .push_back(k);
      }
    }
  }

  NloptResult go();

 private:
  using Sides = std::vector<std::size_t>;
  struct Group {
    Run* run = nullptr;
    const Sides* sides = nullptr;
  };

  /// As in NloptTask::one_sided.
  double sign_of(std::size_t side) const {
    const auto k = static_cast<Eigen::Index>(side);
    return k < task_.one_sided.size() ? task_.one_sided[k] : 0.0;
  }
  void set_up();
  void add_constraints();
  // The point at s, with derivatives if asked; null: failed, or halted, and
  // then the library is told to stop.
  const MinimizePoint* at(const double* s, bool derivatives);
  bool uses_up_box(const VectorX& x, const MinimizePoint& point) const;
  double composite(const MinimizePoint& point, double* gradient);
  double feasible_first(const MinimizePoint& point) const;
  double wall() const;
  VectorX slope(const MinimizePoint& point, const ConstraintSide& side) const;

  // Called from C: nothing may be thrown here.
  static double objective(unsigned n, const double* s, double* gradient,
                          void* data);
  static void constraints(unsigned m, double* result, unsigned n,
                          const double* s, double* gradient, void* data);

  MinimizeEvaluator& evaluator_;
  const NloptTraits& traits_;
  const NloptTask& task_;
  VectorX units_;
  VectorX low_;  // the box within the bounds
  VectorX high_;
  nlopt::opt optimizer_;
  Sides lagrangian_;
  Sides inequalities_;
  Sides equations_;
  Group inequality_group_;
  Group equation_group_;
  int failures_ = 0;  // more than answers
  bool box_used_up_ = false;
  VectorX last_;  // linearised point
  double worst_ = -std::numeric_limits<double>::infinity();
};

const MinimizePoint* Run::at(const double* s, bool derivatives) {
  VectorX x = Eigen::Map<const VectorX>(s, units_.size()).cwiseProduct(units_);
  if (traits_.method.gradients) {
    x = evaluator_.place(x);
  }
  const int evaluations = evaluator_.evaluations();
  const MinimizePoint* point = evaluator_.evaluate(x, EvaluationPhase::Step);
  if (point != nullptr && !point->failure && derivatives) {
    point = evaluator_.linearise(x);
  }
  const bool failed = point == nullptr || point->failure;
  if (evaluator_.evaluations() > evaluations) {
    failures_ = std::max(0, failures_ + (failed ? 1 : -1));
  }
  last_ = !failed && derivatives ? x : last_;
  box_used_up_ = !failed && derivatives && uses_up_box(x, *point);
  if (evaluator_.halted() || box_used_up_ ||
      (traits_.infinite_wall && failures_ > kMostFailures)) {
    optimizer_.force_stop();
    return nullptr;
  }
  return failed ? nullptr : point;
}

bool Run::uses_up_box(const VectorX& x, const MinimizePoint& point) const {
  if (task_.radius >= 1.0 || !lagrangian_.empty() ||
      evaluator_.violation(point.values) > kMissedInBox) {
    return false;
  }
  const double ahead = task_.radius * evaluator_.conditions(x, point).residual;
  return evaluator_.conditions(x, point, low_, high_, high_ - low_).residual <=
         kLeftInBox * ahead;
}

double Run::wall() const {
  return traits_.infinite_wall ? HUGE_VAL
                               : worst_ + kWall * (1.0 + std::abs(worst_));
}

VectorX Run::slope(const MinimizePoint& point,
                   const ConstraintSide& side) const {
  return side.slope_factor(point.values) *
         point.jacobian->row(side.row).transpose().cwiseProduct(units_);
}

double Run::feasible_first(const MinimizePoint& point) const {
  double off = 0.0;
  for (const ConstraintSide& side : evaluator_.sides()) {
    const double value = side.value(point.values);
    off += side.equation ? std::max(std::abs(value) - kLooseEquation, 0.0)
                         : std::max(value, 0.0);
  }
  const double unit = evaluator_.objective_unit();
  return off > 0.0 ? evaluator_.worst_objective() / unit + off
                   : point.values[0] / unit;
}

double Run::composite(const MinimizePoint& point, double* gradient) {
  if (traits_.style == ConstraintStyle::FeasibleFirst) {
    return feasible_first(point);
  }
  const double unit = evaluator_.objective_unit();
  double value = point.values[0] / unit;
  VectorX slopes = VectorX::Zero(units_.size());
  if (gradient != nullptr) {
    slopes = point.jacobian->row(0).transpose().cwiseProduct(units_) / unit;
  }
  for (const std::size_t k : lagrangian_) {
    const ConstraintSide& side = evaluator_.sides()[k];
    const double shift = task_.multipliers[static_cast<Eigen::Index>(k)];
    const double g = side.value(point.values) + shift / task_.rho;
    if (side.equation || g > 0.0) {
      value += 0.5 * task_.rho * g * g;
      if (gradient != nullptr) {
        slopes += task_.rho * g * slope(point, side);
      }
    }
  }
  if (gradient != nullptr) {
    Eigen::Map<VectorX>(gradient, units_.size()) = slopes;
  }
  return value;
}

double Run::objective(unsigned n, const double* s, double* gradient,
                      void* data) {
  Run& run = *static_cast<Run*>(data);
  const MinimizePoint* point = run.at(s, gradient != nullptr);
  if (point == nullptr) {
    if (gradient != nullptr) {
      std::fill_n(gradient, n, 0.0);
    }
    return run.wall();
  }
  const double value = run.composite(*point, gradient);
  run.worst_ = std::max(run.worst_, value);
  return value;
}

void Run::constraints(unsigned m, double* result, unsigned n, const double* s,
                      double* gradient, void* data) {
  const Group& group = *static_cast<Group*>(data);
  Run& run = *group.run;
  const MinimizePoint* point = run.at(s, gradient != nullptr);
  if (point == nullptr) {
    std::fill_n(result, m,
                run.traits_.infinite_wall
                    ? HUGE_VAL
                    : kWall + run.evaluator_.worst_violation());
    if (gradient != nullptr) {
      std::fill_n(gradient, std::size_t{m} * n, 0.0);
    }
    return;
  }
  for (unsigned i = 0; i < m; ++i) {
    const std::size_t k = (*group.sides)[i];
    const ConstraintSide& side = run.evaluator_.sides()[k];
    const double sign = run.sign_of(k) < 0.0 ? -1.0 : 1.0;
    result[i] = sign * side.value(point->values);
    if (gradient != nullptr) {
      Eigen::Map<VectorX>(gradient + std::size_t{i} * n, n) =
          sign * run.slope(*point, side);
    }
  }
}

void Run::add_constraints() {
  const double tolerance = std::max(
      task_.loose, kTolerancePart * evaluator_.options().feasibility_tolerance);
  inequality_group_ = {this, &inequalities_};
  equation_group_ = {this, &equations_};
  if (!inequalities_.empty()) {
    optimizer_.add_inequality_mconstraint(
        constraints, &inequality_group_,
        std::vector<double>(inequalities_.size(), tolerance));
  }
  if (!equations_.empty()) {
    optimizer_.add_equality_mconstraint(
        constraints, &equation_group_,
        std::vector<double>(equations_.size(), tolerance));
  }
}

void Run::set_up() {
  optimizer_.set_min_objective(objective, this);
  optimizer_.set_lower_bounds(to_vector(low_.cwiseQuotient(units_)));
  optimizer_.set_upper_bounds(to_vector(high_.cwiseQuotient(units_)));
  optimizer_.set_initial_step(
      to_vector(task_.first_step * (high_ - low_).cwiseQuotient(units_)));
  const bool gradients = traits_.method.gradients;
  const double step =
      gradients && lagrangian_.empty() ? kGradientStep : task_.step_tolerance;
  optimizer_.set_xtol_abs(
      to_vector(step * evaluator_.ranges().cwiseQuotient(units_)));
  if (gradients) {
    optimizer_.set_ftol_rel(std::max(kGradientGain, task_.least_gain));
  }
  optimizer_.set_maxeval(kMoreCalls + kCallsPerEvaluation *
                                          evaluator_.options().max_evaluations);
  add_constraints();
}

NloptResult Run::go() {
  NloptResult result;
  std::vector<double> s = to_vector(task_.start.cwiseQuotient(units_));
  double least = 0.0;
  try {
    nlopt::srand(evaluator_.options().seed);
    set_up();
    const nlopt::result code = optimizer_.optimize(s, least);
    result.finished =
        code != nlopt::MAXEVAL_REACHED && code != nlopt::MAXTIME_REACHED;
    result.message =
        code == nlopt::FTOL_REACHED   ? "the objective no longer changes"
        : code == nlopt::XTOL_REACHED ? "the steps are too small to matter"
                                      : "the method ended by itself";
  } catch (const nlopt::forced_stop&) {
    if (box_used_up_) {
      result.box_used_up = true;
      s = to_vector(last_.cwiseQuotient(units_));
    }
    result.message = "only designs that cannot be evaluated lie ahead";
  } catch (const nlopt::roundoff_limited&) {
    result.message = "rounding limits further progress";
  } catch (const std::exception& error) {
    result.message = fmt::format("NLopt gave up: {}", error.what());
  }
  result.iterations = optimizer_.get_numevals();
  result.x = Eigen::Map<const VectorX>(s.data(), units_.size())
                 .cwiseProduct(units_)
                 .cwiseMax(evaluator_.lower())
                 .cwiseMin(evaluator_.upper());
  return result;
}

}  // namespace

const std::vector<NloptTraits>& nlopt_traits() {
  using Style = ConstraintStyle;
  static const std::vector<NloptTraits> table = {
      {{"slsqp", true, false}, -1, Style::TrustRegion, true, false},
      {{"mma", true, false},
       nlopt::LD_MMA,
       Style::NativeInequalities,
       true,
       false},
      {{"ccsa", true, false},
       nlopt::LD_CCSAQ,
       Style::NativeInequalities,
       true,
       false},
      {{"bobyqa", false, false},
       nlopt::LN_BOBYQA,
       Style::Lagrangian,
       false,
       false,
       true},
      {{"cobyla", false, false},
       nlopt::LN_COBYLA,
       Style::Native,
       false,
       false,
       true},
      {{"sbplx", false, false},
       nlopt::LN_SBPLX,
       Style::Lagrangian,
       false,
       true,
       true},
      {{"neldermead", false, false},
       nlopt::LN_NELDERMEAD,
       Style::Lagrangian,
       false,
       true,
       true},
      {{"isres", false, true}, nlopt::GN_ISRES, Style::Native, false, false},
      {{"crs2", false, true},
       nlopt::GN_CRS2_LM,
       Style::FeasibleFirst,
       false,
       false},
      {{"direct_l", false, true},
       nlopt::GN_DIRECT_L,
       Style::FeasibleFirst,
       false,
       false,
       true},
  };
  return table;
}

bool in_lagrangian(const NloptTraits& traits, const ConstraintSide& side) {
  return traits.style == ConstraintStyle::Lagrangian ||
         (traits.style == ConstraintStyle::NativeInequalities && side.equation);
}

NloptResult run_nlopt(MinimizeEvaluator& evaluator, const NloptTraits& traits,
                      const NloptTask& task) {
  return Run(evaluator, traits, task).go();
}

}  // namespace meniscus::optimize
