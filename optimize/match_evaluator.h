/// Where a match calls its function: keeps the incumbent by cost and stops
/// when every mismatch is within tolerance.
#pragma once

#include "optimize/evaluator_core.h"

namespace meniscus::optimize {

class MatchEvaluator : public EvaluatorCore {
 public:
  /// Keeps references to function and options; throws InvalidInput for bad
  /// bounds, start or options.
  MatchEvaluator(std::vector<Variable> variables,
                 const ResidualFunction& function, const MatchOptions& options);

  /// The answer at x (moved into the bounds), from memory if it was asked
  /// before; null once halted, and then the caller leaves its library. Never
  /// throws: what the function throws is kept for rethrow().
  const ResidualAnswer* evaluate(const VectorX& x,
                                 EvaluationPhase phase) noexcept;
  /// d residual / d x at x, which has answered: the function's own, that of
  /// options.jacobian, or null when there is none or it failed.
  const Eigen::MatrixXd* jacobian(const VectorX& x) noexcept;

  /// x within the bounds, or the first point asked that is the same design as
  /// far as steps of a search go: what to evaluate in the place of x.
  VectorX place(const VectorX& x) const {
    return memory_.place(inside(x), ranges(), same_design());
  }
  double same_design() const { return same_design_at(options_.tolerance); }

  const MatchOptions& options() const { return options_; }
  bool has_best() const { return best_x_.size() > 0; }
  const VectorX& best() const { return best_x_; }
  const ResidualAnswer& best_answer() const { return best_answer_; }
  double worst_cost() const { return worst_cost_; }  // of those that answered
  Eigen::Index residual_count() const { return residual_count_; }
  /// True when every answer so far had the same residuals, bit for bit.
  bool all_answers_equal() const { return all_equal_; }

 private:
  const ResidualAnswer* ask(const VectorX& x, EvaluationPhase phase);
  const Eigen::MatrixXd* ask_jacobian(const VectorX& x);
  void check(ResidualAnswer& answer);
  void account(const VectorX& x, const ResidualAnswer& answer);

  const ResidualFunction& function_;
  const MatchOptions& options_;
  AnswerMemory<ResidualAnswer> memory_;
  VectorX best_x_;
  ResidualAnswer best_answer_;
  VectorX first_residuals_;
  bool all_equal_ = true;
  double worst_cost_ = 0.0;
  Eigen::Index residual_count_ = 0;
};

double cost_of(const ResidualAnswer& answer);         // |r|^2 / 2
double worst_mismatch(const ResidualAnswer& answer);  // largest |mismatch|

}  // namespace meniscus::optimize
