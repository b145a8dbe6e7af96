/// Where a minimisation calls its function: scales values, keeps the
/// incumbent, and stops at a point that meets the first-order conditions.
#pragma once

#include <cmath>

#include "optimize/evaluator_core.h"
#include "optimize/minimize.h"

namespace meniscus::optimize {

/// One side of a constraint: sign (value[row] - bound) / scale <= 0, or = 0.
/// Squared, sign (value |value| - bound |bound|) / (2 |bound| scale), which has
/// the same value and slope at the bound to first order.
struct ConstraintSide {
  Eigen::Index row = 0;  // of the values; 0 is the objective
  double sign = 1.0;
  double bound = 0.0;
  double scale = 1.0;
  bool equation = false;
  bool squared = false;

  double value(const VectorX& values) const {
    const double v = values[row];
    const double above =
        squared ? 0.5 * (v * std::abs(v) / std::abs(bound) - bound) : v - bound;
    return sign * above / scale;
  }
  /// What the value's row of the Jacobian is multiplied by.
  double slope_factor(const VectorX& values) const {
    return sign / scale * (squared ? std::abs(values[row] / bound) : 1.0);
  }
};

struct MinimizePoint {
  VectorX values;
  std::optional<Eigen::MatrixXd> jacobian;
  std::optional<Failure> failure;  // then the rest is empty
};

class MinimizeEvaluator : public EvaluatorCore {
 public:
  /// Keeps references to both; throws InvalidInput for what cannot work.
  MinimizeEvaluator(const MinimizeProblem& problem,
                    const MinimizeOptions& options);

  /// As MatchEvaluator::evaluate.
  const MinimizePoint* evaluate(const VectorX& x,
                                EvaluationPhase phase) noexcept;
  /// The point at x with its Jacobian, the problem's own or by differences;
  /// null once halted, also because x is a minimum (known once the scales are
  /// fixed). x must have answered.
  const MinimizePoint* linearise(const VectorX& x) noexcept;
  /// Fixes the scales by the first point that answered; with its derivatives
  /// when `derivatives` is given. To be called once, before sides().
  void fix_scales(const VectorX& start, const Eigen::MatrixXd* derivatives);

  /// x within the bounds, or the first point asked that is the same design as
  /// far as steps of a search with derivatives go.
  VectorX place(const VectorX& x) const {
    return memory_.place(inside(x), ranges(), same_design());
  }
  double same_design() const {
    return same_design_at(options_.optimality_tolerance);
  }

  const MinimizeProblem& problem() const { return problem_; }
  const MinimizeOptions& options() const { return options_; }
  const std::vector<ConstraintSide>& sides() const { return sides_; }
  /// What NLopt sees as 1 of the objective.
  double objective_unit() const { return objective_unit_; }
  double objective_scale() const;  // FirstOrderInput's
  /// The largest side's value, equations by magnitude; 0 when all are kept.
  double violation(const VectorX& values) const;
  bool keeps_all(const VectorX& values) const {
    return violation(values) <= options_.feasibility_tolerance;
  }
  FirstOrderReport conditions(const VectorX& x,
                              const MinimizePoint& point) const {
    return conditions(x, point, lower(), upper(), ranges());
  }
  /// The same with other bounds on the variables, and other units of them.
  FirstOrderReport conditions(const VectorX& x, const MinimizePoint& point,
                              const VectorX& low, const VectorX& high,
                              const VectorX& units) const;

  bool has_best() const { return best_x_.size() > 0; }
  const VectorX& best() const { return best_x_; }
  const MinimizePoint& best_point() { return *memory_.find(best_x_); }
  double best_violation() const { return best_violation_; }
  double best_objective() const { return best_objective_; }
  bool best_is_feasible() const {
    return has_best() && best_violation_ <= options_.feasibility_tolerance;
  }
  /// True once two answers had different objectives.
  bool objective_varies() const { return varies_; }
  int answered() const { return evaluations() - failed_evaluations(); }
  double worst_violation() const { return worst_violation_; }
  double worst_objective() const { return worst_objective_; }

 private:
  const MinimizePoint* ask(const VectorX& x, EvaluationPhase phase);
  const MinimizePoint* ask_jacobian(const VectorX& x);
  bool differentiate(const VectorX& x, MinimizePoint& point);
  void check(MinimizePoint& point) const;
  void account(const VectorX& x, const MinimizePoint& point);
  void make_incumbent(const VectorX& x, const VectorX& values);
  void make_sides(const VectorX& start, const Eigen::MatrixXd* derivatives);

  const MinimizeProblem& problem_;
  const MinimizeOptions& options_;
  AnswerMemory<MinimizePoint> memory_;
  std::vector<ConstraintSide> sides_;
  VectorX constraint_scale_;
  double objective_unit_ = 1.0;
  double start_objective_ = 0.0;
  VectorX best_x_;
  double best_violation_ = 0.0;
  double best_objective_ = 0.0;
  double worst_violation_ = 0.0;
  double worst_objective_ = 0.0;
  bool varies_ = false;
  bool scaled_ = false;
};

}  // namespace meniscus::optimize
