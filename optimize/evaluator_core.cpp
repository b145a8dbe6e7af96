#include "optimize/evaluator_core.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace meniscus::optimize {

std::string limit_text(int evaluations, int earlier) {
  return fmt::format(
      "limit of {} evaluations{}", evaluations + earlier,
      earlier > 0 ? fmt::format(" ({} before, {} here)", earlier, evaluations)
                  : "");
}

std::string evaluations_text(int evaluations, int earlier) {
  return fmt::format("{} evaluation{}{}", evaluations,
                     evaluations == 1 ? "" : "s",
                     earlier > 0 ? " on its model" : "");
}

namespace {

// A variable this close to a bound, x range, counts as being there.
constexpr double kAtBound = 1e-9;

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

void check_limits(const EvaluationLimits& limits) {
  if (limits.max_evaluations < 1) {
    throw InvalidInput(
        fmt::format("{}: max_evaluations is {}, must be at least 1",
                    limits.study, limits.max_evaluations));
  }
  if (!(limits.time_limit >= 0.0)) {
    throw InvalidInput(
        fmt::format("{}: time_limit is {} s, must be 0 (none) or positive",
                    limits.study, limits.time_limit));
  }
  if (!(limits.difference_step > 0.0 && limits.difference_step <= 0.5)) {
    throw InvalidInput(fmt::format(
        "{}: difference_step is {}, must be in (0, 0.5] of each variable's "
        "range",
        limits.study, limits.difference_step));
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

}  // namespace

void check_variables(const std::vector<Variable>& variables,
                     const char* study) {
  if (variables.empty()) {
    throw InvalidInput(fmt::format(
        "{}: there is no design variable; declare at least one under "
        "[design.NAME] with initial and bounds",
        study));
  }
  for (const Variable& variable : variables) {
    check_variable(variable);
  }
}

EvaluatorCore::EvaluatorCore(std::vector<Variable> variables,
                             EvaluationLimits limits)
    : variables_(std::move(variables)),
      limits_(std::move(limits)),
      monitor_(limits_.monitor != nullptr ? *limits_.monitor
                                          : silent_monitor()) {
  check_variables(variables_, limits_.study);
  check_limits(limits_);
  ranges_ = upper() - lower();
  for (std::size_t j = 0; j < variables_.size(); ++j) {
    double& range = ranges_[static_cast<Eigen::Index>(j)];
    range = variables_[j].range.value_or(range);
  }
}

VectorX EvaluatorCore::start() const {
  return collect(variables_, &Variable::initial);
}
VectorX EvaluatorCore::lower() const {
  return collect(variables_, &Variable::lower);
}
VectorX EvaluatorCore::upper() const {
  return collect(variables_, &Variable::upper);
}

void EvaluatorCore::rethrow() const {
  if (exception_ != nullptr) {
    std::rethrow_exception(exception_);
  }
}

VectorX EvaluatorCore::inside(const VectorX& x) const {
  // + 0 turns -0 into 0: one point, one key.
  return (x.cwiseMax(lower()).cwiseMin(upper()).array() + 0.0).matrix();
}

bool EvaluatorCore::begin(EvaluationPhase phase) {
  throw_if_stopped(monitor_, limits_.study);
  const bool gradient = phase == EvaluationPhase::Gradient;
  if (!gradient && evaluations_ >= limits_.max_evaluations) {
    halt_ = Halt::Evaluations;
  } else if (!gradient && stage_ > 0 && evaluations_ >= stage_) {
    halt_ = Halt::Stage;
  } else if (limits_.time_limit > 0.0 && evaluations_ > 0 &&
             timer_.seconds() >= limits_.time_limit) {
    halt_ = Halt::Time;
  }
  if (halted()) {
    return false;
  }
  if (limits_.announce) {
    limits_.announce(phase);
  }
  ++(gradient ? gradients_ : evaluations_);
  return true;
}

void EvaluatorCore::end_stage() {
  stage_ = 0;
  if (halt_ == Halt::Stage) {
    halt_ = Halt::None;
  }
}

void EvaluatorCore::count_failure(const VectorX& x, const Failure& failure) {
  ++failed_;
  last_failure_ = failure;
  monitor_.log(
      Severity::Debug,
      fmt::format("evaluation {} at {} failed ({}): {}", evaluations_,
                  describe(x), name_of(failure.kind), failure.message));
}

void EvaluatorCore::report_progress(const std::string& detail) {
  monitor_.progress({limits_.study,
                     fmt::format("evaluation {}: {}", evaluations_, detail),
                     -1.0});
}

Eigen::Index EvaluatorCore::group_end(Eigen::Index i) const {
  const std::string& group = variables_[static_cast<std::size_t>(i)].group;
  Eigen::Index end = i + 1;
  while (!group.empty() && end < size() &&
         variables_[static_cast<std::size_t>(end)].group == group) {
    ++end;
  }
  return end;
}

std::string EvaluatorCore::describe(const VectorX& x) const {
  std::string text;
  for (Eigen::Index i = 0, end = 0; i < x.size(); i = end) {
    const Variable& variable = variables_[static_cast<std::size_t>(i)];
    end = group_end(i);
    const auto values = x.segment(i, end - i);
    const std::string least = variable.shown.text(values.minCoeff());
    const std::string most = variable.shown.text(values.maxCoeff());
    text += text.empty() ? "" : ", ";
    text += variable.group.empty()
                ? fmt::format("{} = {}", variable.name, least)
            : least == most
                ? fmt::format("{} = {} each", variable.group, least)
                : fmt::format("{} = {} to {}", variable.group, least, most);
  }
  return text;
}

std::string EvaluatorCore::bounds_reached(const VectorX& x) const {
  std::string text;
  for (Eigen::Index i = 0, end = 0; i < size(); i = end) {
    const Variable& variable = variables_[static_cast<std::size_t>(i)];
    end = group_end(i);
    std::array<int, 2> reached = {0, 0};  // lower, upper
    for (Eigen::Index k = i; k < end; ++k) {
      const Variable& at = variables_[static_cast<std::size_t>(k)];
      const double near = kAtBound * ranges_[k];
      const bool low = x[k] <= at.lower + near;
      reached[0] += low ? 1 : 0;
      reached[1] += !low && x[k] >= at.upper - near ? 1 : 0;
    }
    const char* what = variable.range ? "end here" : "bound";
    for (const bool low : {true, false}) {
      const int count = reached[low ? 0 : 1];
      if (count == 0) {
        continue;
      }
      text += text.empty() ? "" : ", ";
      text +=
          variable.group.empty()
              ? fmt::format(
                    "{} at its {} {}{} {}", variable.name,
                    low ? "lower" : "upper", what, variable.range ? "," : "",
                    variable.shown.text(low ? variable.lower : variable.upper))
              : fmt::format("{} of {} elements of {} at {} {}", count, end - i,
                            variable.group, low ? "a lower" : "an upper", what);
    }
  }
  return text;
}

std::string EvaluatorCore::failures() const {
  if (failed_ == 0) {
    return "";
  }
  return fmt::format(", {} of which could not be evaluated (last: {}: {})",
                     failed_, name_of(last_failure_.kind),
                     last_failure_.message);
}

}  // namespace meniscus::optimize
