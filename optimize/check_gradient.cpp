#include "optimize/check_gradient.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace meniscus::optimize {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class Sweep {
 public:
  Sweep(const std::vector<Variable>& variables, const VectorFunction& function,
        Monitor& monitor)
      : variables_(variables), function_(function), monitor_(monitor) {
    x_.resize(static_cast<Eigen::Index>(variables.size()));
    for (std::size_t j = 0; j < variables.size(); ++j) {
      x_[static_cast<Eigen::Index>(j)] = variables[j].initial;
    }
    const VectorAnswer answer = ask(x_);
    if (answer.failure) {
      throw InvalidInput(
          fmt::format("gradient check: the initial values cannot be evaluated "
                      "({}: {}); start from a design that works",
                      name_of(answer.failure->kind), answer.failure->message));
    }
    centre_ = answer.values;
  }

  // d values / d x_j with step h; NaN when a point fails.
  VectorX difference(Eigen::Index j, double h) {
    const Variable& variable = variables_[static_cast<std::size_t>(j)];
    if (x_[j] + h <= variable.upper && x_[j] - h >= variable.lower) {
      return (at(j, h) - at(j, -h)) / (2.0 * h);
    }
    const double s = x_[j] + 2.0 * h <= variable.upper ? h : -h;
    return (4.0 * at(j, s) - 3.0 * centre_ - at(j, 2.0 * s)) / (2.0 * s);
  }

  const VectorX& centre() const { return centre_; }
  int evaluations() const { return evaluations_; }

 private:
  VectorAnswer ask(const VectorX& x) {
    throw_if_stopped(monitor_, "gradient check");
    ++evaluations_;
    return function_(x);
  }

  VectorX at(Eigen::Index j, double h) {
    VectorX x = x_;
    x[j] += h;
    const VectorAnswer answer = ask(x);
    if (answer.failure || answer.values.size() != centre_.size()) {
      return VectorX::Constant(centre_.size(), kNaN);
    }
    return answer.values;
  }

  const std::vector<Variable>& variables_;
  const VectorFunction& function_;
  Monitor& monitor_;
  VectorX x_;
  VectorX centre_;
  int evaluations_ = 0;
};

void check_input(const std::vector<Variable>& variables,
                 const std::vector<std::string>& responses,
                 const Eigen::MatrixXd& given,
                 const GradientCheckOptions& options) {
  if (given.rows() != static_cast<Eigen::Index>(responses.size()) ||
      given.cols() != static_cast<Eigen::Index>(variables.size())) {
    throw InvalidInput(fmt::format(
        "gradient check: the given derivatives are {} x {}, expected {} "
        "responses x {} variables",
        given.rows(), given.cols(), responses.size(), variables.size()));
  }
  const auto fit = [](const std::vector<double>& steps) {
    return std::all_of(steps.begin(), steps.end(),
                       [](double h) { return h > 0.0 && h <= 0.25; });
  };
  const bool steps_fit = options.steps.size() >= 2 && fit(options.steps) &&
                         fit(options.finer_steps);
  if (!steps_fit) {
    throw InvalidInput(
        "gradient check: give at least two steps, each in (0, 0.25] of the "
        "variable's range");
  }
  for (const Variable& variable : variables) {
    if (!(variable.lower < variable.upper)) {
      throw InvalidInput(fmt::format(
          "gradient check: design variable '{}' has bounds [{}, {}]; the lower "
          "must be below the upper",
          variable.name, variable.lower, variable.upper));
    }
  }
}

double size_of(double derivative, double value, double range) {
  return std::max(std::abs(derivative), std::abs(value) / range);
}

// The plateau: two neighbours of the sweep that agree well within the
// tolerance, those of the smallest steps first. Truncation and kinks of the
// function fade with the step; rounding grows, and shows as disagreement. Where
// no two agree so well, those that differ least.
class Plateau {
 public:
  // `fine` and `coarse`: the differences of a step and of the next larger one;
  // `allowed`: the error that a derivative may have.
  void compare(double fine, double coarse, double fine_step, double allowed) {
    const double gap = std::abs(coarse - fine);
    if (!reached() && gap < least_) {  // false for NaN
      least_ = gap;
      allowed_ = allowed;
      difference_ = fine;
      step_ = fine_step;
    }
  }

  bool reached() const {
    constexpr double kWellWithin = 0.1;
    return least_ <= kWellWithin * allowed_;
  }
  // Two agree, if not well: what differs is the rounding, and smaller steps
  // would agree by chance only.
  bool within_tolerance() const { return least_ <= allowed_; }
  double difference() const { return difference_; }
  double step() const { return step_; }

 private:
  double least_ = std::numeric_limits<double>::infinity();  // gap
  double allowed_ = 0.0;                                    // there
  double difference_ = kNaN;
  double step_ = 0.0;
};

// One for each value, by variable j. Steps grow until all are reached; where
// for some no two agree within the tolerance, they shrink from the smallest.
std::vector<Plateau> find_plateaus(Sweep& sweep, std::size_t j, double range,
                                   const GradientCheckOptions& options) {
  const VectorX& centre = sweep.centre();
  std::vector<Plateau> plateaus(static_cast<std::size_t>(centre.size()));
  const auto difference = [&](double step) {
    return sweep.difference(static_cast<Eigen::Index>(j), step * range);
  };
  const auto compare = [&](const VectorX& fine, const VectorX& coarse,
                           double fine_step) {
    for (std::size_t i = 0; i < plateaus.size(); ++i) {
      const auto line = static_cast<Eigen::Index>(i);
      plateaus[i].compare(
          fine[line], coarse[line], fine_step * range,
          options.tolerance * size_of(fine[line], centre[line], range));
    }
  };
  const auto all = [&](bool (Plateau::*holds)() const) {
    return std::all_of(plateaus.begin(), plateaus.end(), std::mem_fn(holds));
  };
  const VectorX finest = difference(options.steps.back());
  VectorX last = finest;
  for (std::size_t k = options.steps.size() - 1;
       k > 0 && !all(&Plateau::reached); --k) {
    const VectorX coarse = difference(options.steps[k - 1]);
    compare(last, coarse, options.steps[k]);
    last = coarse;
  }
  last = finest;
  for (std::size_t k = 0;
       k < options.finer_steps.size() && !all(&Plateau::within_tolerance);
       ++k) {
    const VectorX fine = difference(options.finer_steps[k]);
    compare(fine, last, options.finer_steps[k]);
    last = fine;
  }
  return plateaus;
}

void set_error(double value, double range, double tolerance,
               GradientCheckRow& row) {
  row.error = std::abs(row.given - row.difference);
  row.allowed = tolerance * size_of(row.given, value, range);
  row.passed = row.error <= row.allowed;  // false for NaN
}

void summarise(GradientCheckReport& report) {
  const GradientCheckRow* worst = nullptr;
  double worst_excess = 0.0;
  for (const GradientCheckRow& row : report.rows) {
    const double excess = row.error <= row.allowed ? 0.0
                          : std::isfinite(row.error)
                              ? row.error - row.allowed
                              : std::numeric_limits<double>::infinity();
    if (!row.passed && (worst == nullptr || excess > worst_excess)) {
      worst = &row;
      worst_excess = excess;
    }
  }
  report.passed = worst == nullptr;
  report.message =
      report.passed
          ? fmt::format("all {} derivatives agree with central differences",
                        report.rows.size())
          : fmt::format(
                "d {} / d {}: given {:.8g}, by differences {:.8g} "
                "(step {:.3g}); they differ by {:.2g}, allowed {:.2g}",
                worst->response, worst->variable, worst->given,
                worst->difference, worst->step, worst->error, worst->allowed);
}

}  // namespace

GradientCheckReport check_gradient(const std::vector<Variable>& variables,
                                   const std::vector<std::string>& responses,
                                   const VectorFunction& function,
                                   const Eigen::MatrixXd& given,
                                   const GradientCheckOptions& options) {
  check_input(variables, responses, given, options);
  Monitor& monitor =
      options.monitor != nullptr ? *options.monitor : silent_monitor();
  // The centre is evaluated once; one-sided differences use it.
  Sweep sweep(variables, function, monitor);
  if (sweep.centre().size() != given.rows()) {
    throw InvalidInput(fmt::format(
        "gradient check: the function answers with {} values, expected {}",
        sweep.centre().size(), given.rows()));
  }

  GradientCheckReport report;
  report.rows.resize(responses.size() * variables.size());
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const double range = variables[j].upper - variables[j].lower;
    // Second-order differences: truncation falls with h^2, rounding grows with
    // 1 / h; compared at the plateau between the two.
    const std::vector<Plateau> plateaus =
        find_plateaus(sweep, j, range, options);
    for (std::size_t i = 0; i < responses.size(); ++i) {
      const auto line = static_cast<Eigen::Index>(i);
      GradientCheckRow& row = report.rows[i * variables.size() + j];
      row.response = responses[i];
      row.variable = variables[j].name;
      row.given = given(line, column);
      row.difference = plateaus[i].difference();
      row.step = plateaus[i].step();
      set_error(sweep.centre()[line], range, options.tolerance, row);
    }
  }
  report.evaluations = sweep.evaluations();
  summarise(report);
  return report;
}

}  // namespace meniscus::optimize
