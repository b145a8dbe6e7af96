#include "optimize/match_evaluator.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace meniscus::optimize {
namespace {

EvaluationLimits match_limits(const MatchOptions& options) {
  if (!(options.tolerance > 0.0)) {
    throw InvalidInput(fmt::format("match: tolerance is {}, must be positive",
                                   options.tolerance));
  }
  return {.study = "match",
          .max_evaluations = options.max_evaluations,
          .time_limit = options.time_limit,
          .difference_step = options.difference_step,
          .monitor = options.monitor,
          .announce = options.announce,
          .prefetch = options.prefetch};
}

}  // namespace

double cost_of(const ResidualAnswer& answer) {
  return 0.5 * answer.residuals.squaredNorm();
}

double worst_mismatch(const ResidualAnswer& answer) {
  return answer.mismatch.size() == 0 ? 0.0
                                     : answer.mismatch.cwiseAbs().maxCoeff();
}

MatchEvaluator::MatchEvaluator(std::vector<Variable> variables,
                               const ResidualFunction& function,
                               const MatchOptions& options)
    : EvaluatorCore(std::move(variables), match_limits(options)),
      function_(function),
      options_(options) {}

const ResidualAnswer* MatchEvaluator::evaluate(const VectorX& x,
                                               EvaluationPhase phase) noexcept {
  return guarded([&] { return ask(x, phase); });
}

const Eigen::MatrixXd* MatchEvaluator::jacobian(const VectorX& x) noexcept {
  return guarded([&] { return ask_jacobian(x); });
}

const ResidualAnswer* MatchEvaluator::ask(const VectorX& x,
                                          EvaluationPhase phase) {
  const VectorX point = inside(x);
  if (const ResidualAnswer* known = memory_.find(point)) {
    return known;
  }
  if (!begin(phase)) {
    return nullptr;
  }
  ResidualAnswer answer = function_(point);
  check(answer);
  const ResidualAnswer& kept = memory_.keep(point, std::move(answer));
  account(point, kept);
  return halted() ? nullptr : &kept;
}

const Eigen::MatrixXd* MatchEvaluator::ask_jacobian(const VectorX& x) {
  const VectorX point = inside(x);
  ResidualAnswer* known = memory_.find(point);
  if (known == nullptr || known->failure) {
    return nullptr;
  }
  if (!known->jacobian && options_.jacobian &&
      begin(EvaluationPhase::Gradient)) {
    JacobianAnswer answer = options_.jacobian(point);
    if (!answer.failure && answer.jacobian.allFinite()) {
      known->jacobian = std::move(answer.jacobian);
      check(*known);
    }
  }
  return known->jacobian ? &*known->jacobian : nullptr;
}

void MatchEvaluator::check(ResidualAnswer& answer) {
  if (answer.failure) {
    return;
  }
  if (answer.residuals.size() == 0 || answer.mismatch.size() == 0) {
    throw InvalidInput(
        "match: the function answers with no residual or no "
        "mismatch; name at least one target");
  }
  if (residual_count_ == 0) {
    residual_count_ = answer.residuals.size();
  }
  const bool jacobian_fits =
      !answer.jacobian || (answer.jacobian->rows() == residual_count_ &&
                           answer.jacobian->cols() == size());
  if (answer.residuals.size() != residual_count_ || !jacobian_fits) {
    throw InvalidInput(fmt::format(
        "match: the function answers with {} residuals and a {} x {} "
        "Jacobian; expected {} residuals and {} columns",
        answer.residuals.size(), answer.jacobian ? answer.jacobian->rows() : 0,
        answer.jacobian ? answer.jacobian->cols() : 0, residual_count_,
        size()));
  }
  const bool finite = answer.residuals.allFinite() &&
                      answer.mismatch.allFinite() &&
                      (!answer.jacobian || answer.jacobian->allFinite());
  if (!finite) {
    answer = {};
    answer.failure = Failure{FailureKind::NotANumber,
                             "a residual is NaN or infinite; look for a "
                             "division by zero in the responses"};
  }
}

void MatchEvaluator::account(const VectorX& x, const ResidualAnswer& answer) {
  if (answer.failure) {
    count_failure(x, *answer.failure);
    return;
  }
  if (first_residuals_.size() == 0) {
    first_residuals_ = answer.residuals;
  }
  all_equal_ = all_equal_ && first_residuals_ == answer.residuals;
  const double cost = cost_of(answer);
  const bool within = worst_mismatch(answer) <= options_.tolerance;
  worst_cost_ = std::max(worst_cost_, cost);
  if (!has_best() || within || cost < cost_of(best_answer_)) {
    best_x_ = x;
    best_answer_ = answer;
  }
  report_progress(fmt::format("{}, mismatch {:.3g}, best {:.3g}", describe(x),
                              worst_mismatch(answer),
                              worst_mismatch(best_answer_)));
  if (within) {
    set_halt(Halt::Converged);
  }
}

}  // namespace meniscus::optimize
