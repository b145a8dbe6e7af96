/// Compares given derivatives with central differences over a sweep of steps:
/// large steps err by truncation, small ones by rounding, and a right gradient
/// agrees in between. Larger steps are tried where smaller ones disagree, and
/// smaller ones last.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "optimize/problem.h"

namespace meniscus::optimize {

struct GradientCheckOptions {
  /// Steps of the sweep x (upper - lower), from large to small; at least two,
  /// the smallest of which are evaluated first.
  std::vector<double> steps = {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5};
  /// Tried after them, from large to small, where no two of them agree within
  /// the tolerance: a function with kinks nearby is smooth only within a
  /// smaller step.
  std::vector<double> finer_steps = {3e-6, 1e-6, 3e-7, 1e-7};
  /// A derivative a passes when |a - f| <= tolerance max(|a|, |value| / range).
  double tolerance = 1e-5;
  Monitor* monitor = nullptr;
};

/// One derivative: response i to variable j.
struct GradientCheckRow {
  std::string response;
  std::string variable;
  double given = 0.0;
  /// By central differences: of the smallest step that agrees with its
  /// neighbour in the sweep well within the tolerance, else of the one that
  /// agrees best, found without looking at `given`; NaN when no two
  /// neighbouring steps could be evaluated.
  double difference = std::numeric_limits<double>::quiet_NaN();
  double step = 0.0;     // of `difference` [the variable's unit]
  double error = 0.0;    // |given - difference|
  double allowed = 0.0;  // by options.tolerance
  bool passed = false;
};

struct GradientCheckReport {
  std::vector<GradientCheckRow> rows;  // by response, then by variable
  bool passed = false;
  int evaluations = 0;
  std::string message;  // in words, the worst row named
};

/// `given`: d response_i / d x_j at the variables' initial values, rows by
/// response. Where x +- h leaves the bounds the difference is the one-sided
/// one of second order. Throws InvalidInput for sizes or steps that do not fit
/// and when the function fails at the initial values itself.
GradientCheckReport check_gradient(const std::vector<Variable>& variables,
                                   const std::vector<std::string>& responses,
                                   const VectorFunction& function,
                                   const Eigen::MatrixXd& given,
                                   const GradientCheckOptions& options = {});

}  // namespace meniscus::optimize
