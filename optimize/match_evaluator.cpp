#include "optimize/match_evaluator.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace meniscus {
namespace {

void check_variable(const Variable& variable) {
  const double numbers[] = {variable.lower, variable.initial, variable.upper};
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw InvalidInput(fmt::format(
          "design variable '{}': bounds [{}, {}] and initial value {} must be "
          "finite numbers",
          variable.name, variable.lower, variable.upper, variable.initial));
    }
  }
  if (variable.lower == variable.upper) {
    throw InvalidInput(fmt::format(
        "design variable '{}': both bounds are {}, so it cannot move; widen "
        "them, or make it a parameter",
        variable.name, variable.lower));
  }
  if (variable.lower > variable.upper) {
    throw InvalidInput(
        fmt::format("design variable '{}': lower bound {} is above the upper "
                    "bound {}; swap them",
                    variable.name, variable.lower, variable.upper));
  }
  if (variable.initial < variable.lower || variable.initial > variable.upper) {
    throw InvalidInput(fmt::format(
        "design variable '{}': initial value {} is outside the "
        "bounds [{}, {}]",
        variable.name, variable.initial, variable.lower, variable.upper));
  }
}

void check_options(const MatchOptions& options) {
  if (!(options.tolerance > 0.0)) {
    throw InvalidInput(fmt::format("match: tolerance is {}, must be positive",
                                   options.tolerance));
  }
  if (options.max_evaluations < 1) {
    throw InvalidInput(
        fmt::format("match: max_evaluations is {}, must be at least 1",
                    options.max_evaluations));
  }
  if (!(options.time_limit >= 0.0)) {
    throw InvalidInput(
        fmt::format("match: time_limit is {} s, must be 0 (none) or positive",
                    options.time_limit));
  }
  if (!(options.difference_step > 0.0 && options.difference_step <= 0.5)) {
    throw InvalidInput(fmt::format(
        "match: difference_step is {}, must be in (0, 0.5] of each variable's "
        "range",
        options.difference_step));
  }
}

VectorX collect(const std::vector<Variable>& variables,
                double Variable::*member) {
  VectorX values(static_cast<Eigen::Index>(variables.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = variables[static_cast<std::size_t>(i)].*member;
  }
  return values;
}

std::vector<std::uint64_t> bits_of(const VectorX& x) {
  std::vector<std::uint64_t> bits(static_cast<std::size_t>(x.size()));
  for (std::size_t i = 0; i < bits.size(); ++i) {
    bits[i] = std::bit_cast<std::uint64_t>(x[static_cast<Eigen::Index>(i)]);
  }
  return bits;
}

}  // namespace

double cost_of(const ResidualAnswer& answer) {
  return 0.5 * answer.residuals.squaredNorm();
}

double worst_mismatch(const ResidualAnswer& answer) {
  return answer.mismatch.size() == 0 ? 0.0
                                     : answer.mismatch.cwiseAbs().maxCoeff();
}

MatchEvaluator::MatchEvaluator(const std::vector<Variable>& variables,
                               const ResidualFunction& function,
                               const MatchOptions& options)
    : variables_(variables),
      function_(function),
      options_(options),
      monitor_(options.monitor != nullptr ? *options.monitor
                                          : silent_monitor()) {
  if (variables.empty()) {
    throw InvalidInput(
        "match: there is no design variable; declare at least one under "
        "[design.NAME] with initial and bounds");
  }
  for (const Variable& variable : variables) {
    check_variable(variable);
  }
  check_options(options);
  ranges_ = upper() - lower();
}

VectorX MatchEvaluator::start() const {
  return collect(variables_, &Variable::initial);
}
VectorX MatchEvaluator::lower() const {
  return collect(variables_, &Variable::lower);
}
VectorX MatchEvaluator::upper() const {
  return collect(variables_, &Variable::upper);
}

const ResidualAnswer* MatchEvaluator::evaluate(const VectorX& x,
                                               EvaluationPhase phase) noexcept {
  if (halt_ != Halt::None) {
    return nullptr;
  }
  try {
    return ask(x, phase);
  } catch (...) {
    exception_ = std::current_exception();
    halt_ = Halt::Exception;
    return nullptr;
  }
}

void MatchEvaluator::rethrow() const {
  if (exception_ != nullptr) {
    std::rethrow_exception(exception_);
  }
}

const ResidualAnswer* MatchEvaluator::ask(const VectorX& x,
                                          EvaluationPhase phase) {
  // + 0 turns -0 into 0: one point, one key.
  const VectorX point =
      (x.cwiseMax(lower()).cwiseMin(upper()).array() + 0.0).matrix();
  const Key key = bits_of(point);
  const auto known = memory_.find(key);
  if (known != memory_.end()) {
    return &known->second;
  }
  throw_if_stopped(monitor_, "match");
  if (limit_reached()) {
    return nullptr;
  }
  if (options_.announce) {
    options_.announce(phase);
  }
  ++evaluations_;
  ResidualAnswer answer = function_(point);
  check(answer);
  const ResidualAnswer& kept =
      memory_.emplace(key, std::move(answer)).first->second;
  account(point, kept);
  return halt_ == Halt::None ? &kept : nullptr;
}

bool MatchEvaluator::limit_reached() {
  if (evaluations_ >= options_.max_evaluations) {
    halt_ = Halt::Evaluations;
  } else if (options_.time_limit > 0.0 && evaluations_ > 0 &&
             timer_.seconds() >= options_.time_limit) {
    halt_ = Halt::Time;
  }
  return halt_ != Halt::None;
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
    ++failed_;
    last_failure_ = *answer.failure;
    monitor_.log(
        Severity::Debug,
        fmt::format("evaluation {} at {} failed ({}): {}", evaluations_,
                    describe(x), name_of(answer.failure->kind),
                    answer.failure->message));
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
  monitor_.progress(
      {"match",
       fmt::format("evaluation {}: {}, mismatch {:.3g}, best {:.3g}",
                   evaluations_, describe(x), worst_mismatch(answer),
                   worst_mismatch(best_answer_)),
       -1.0});
  if (within) {
    halt_ = Halt::Converged;
  }
}

std::string MatchEvaluator::describe(const VectorX& x) const {
  std::string text;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    text += fmt::format("{}{} = {:.6g}", i == 0 ? "" : ", ",
                        variables_[static_cast<std::size_t>(i)].name, x[i]);
  }
  return text;
}

}  // namespace meniscus
