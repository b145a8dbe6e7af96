#include "optimize/first_order.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "optimize/quadratic/nonnegative_least_squares.h"

namespace meniscus::optimize {
namespace {

// One inequality side(x) <= 0, multiplier >= 0.
struct Side {
  VectorX gradient;      // in s = x / range, of what is divided by its scale
  double slack = 0.0;    // >= 0, divided by its scale
  Eigen::Index row = 0;  // constraint, or variable when `bound`
  bool bound = false;
  double sign = 0.0;  // +1 at an upper bound, -1 at a lower one
};

void check_sizes(const FirstOrderInput& input) {
  const Eigen::Index n = input.x.size();
  const Eigen::Index m = input.values.size() - 1;
  const bool fits =
      m >= 0 && input.lower.size() == n && input.upper.size() == n &&
      (input.ranges.size() == 0 || input.ranges.size() == n) &&
      input.jacobian.rows() == m + 1 && input.jacobian.cols() == n &&
      input.constraint_lower.size() == m &&
      input.constraint_upper.size() == m && input.constraint_scale.size() == m;
  if (!fits) {
    throw InvalidInput(fmt::format(
        "first-order residual: {} variables, {} values and a {} x {} Jacobian "
        "do not fit together, or the bounds do not fit them",
        n, input.values.size(), input.jacobian.rows(), input.jacobian.cols()));
  }
}

std::vector<Side> sides_of(const FirstOrderInput& input,
                           const VectorX& ranges) {
  std::vector<Side> sides;
  const Eigen::Index n = input.x.size();
  sides.reserve(
      static_cast<std::size_t>(2 * (n + input.constraint_scale.size())));
  for (Eigen::Index i = 0; i < input.constraint_scale.size(); ++i) {
    const double scale = input.constraint_scale[i];
    const VectorX gradient =
        input.jacobian.row(i + 1).transpose().cwiseProduct(ranges) / scale;
    const double value = input.values[i + 1];
    if (std::isfinite(input.constraint_upper[i])) {
      const double slack = (input.constraint_upper[i] - value) / scale;
      sides.push_back({gradient, std::max(slack, 0.0), i, false, 1.0});
    }
    if (std::isfinite(input.constraint_lower[i])) {
      const double slack = (value - input.constraint_lower[i]) / scale;
      sides.push_back({-gradient, std::max(slack, 0.0), i, false, -1.0});
    }
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const double above = (input.x[j] - input.lower[j]) / ranges[j];
    const double below = (input.upper[j] - input.x[j]) / ranges[j];
    sides.push_back({VectorX::Unit(n, j), std::max(below, 0.0), j, true, 1.0});
    sides.push_back(
        {-VectorX::Unit(n, j), std::max(above, 0.0), j, true, -1.0});
  }
  return sides;
}

double violation_of(const FirstOrderInput& input) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < input.constraint_scale.size(); ++i) {
    const double value = input.values[i + 1];
    const double outside = std::max(value - input.constraint_upper[i],
                                    input.constraint_lower[i] - value);
    worst = std::max(worst, outside / input.constraint_scale[i]);
  }
  return worst;
}

}  // namespace

FirstOrderReport first_order(const FirstOrderInput& input) {
  check_sizes(input);
  // With the ranges as units, and f over its scale, the residual is a pure
  // number.
  const VectorX ranges = input.ranges.size() > 0
                             ? input.ranges
                             : VectorX(input.upper - input.lower);
  const Eigen::Index n = ranges.size();
  const VectorX gradient =
      input.jacobian.row(0).transpose().cwiseProduct(ranges);
  const double steepest = n == 0 ? 0.0 : gradient.cwiseAbs().maxCoeff();
  double unit = input.objective_scale > 0.0 ? input.objective_scale : steepest;
  unit = unit > 0.0 ? unit : 1.0;

  // Karush-Kuhn-Tucker: min over m >= 0 of |grad f + sum m_k grad g_k|^2 +
  // sum (m_k g_k)^2, one column per constraint or bound.
  const std::vector<Side> sides = sides_of(input, ranges);
  const auto count = static_cast<Eigen::Index>(sides.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Side& side = sides[static_cast<std::size_t>(k)];
    A.col(k).head(n) = side.gradient;
    A(n + k, k) = side.slack;
  }
  VectorX b = VectorX::Zero(n + count);
  b.head(n) = -gradient / unit;
  // Nonnegative least squares [lawson1974].
  const VectorX multipliers = quadratic::nonnegative_least_squares(A, b);
  const VectorX rest = A * multipliers - b;

  FirstOrderReport report;
  // Largest entries of both sums: stationarity and complementarity.
  report.stationarity = n == 0 ? 0.0 : rest.head(n).cwiseAbs().maxCoeff();
  report.complementarity =
      count == 0 ? 0.0 : rest.tail(count).cwiseAbs().maxCoeff();
  report.residual = std::max(report.stationarity, report.complementarity);
  report.violation = violation_of(input);
  // Back to the given units; a lower side counts with the other sign.
  report.multipliers = VectorX::Zero(input.constraint_scale.size());
  report.bound_multipliers = VectorX::Zero(n);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Side& side = sides[static_cast<std::size_t>(k)];
    const double m = side.sign * unit * multipliers[k];
    if (side.bound) {
      report.bound_multipliers[side.row] += m / ranges[side.row];
    } else {
      report.multipliers[side.row] += m / input.constraint_scale[side.row];
    }
  }
  return report;
}

}  // namespace meniscus::optimize
