#include "optimize/first_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "optimize/quadratic/nonnegative_least_squares.h"

namespace meniscus::optimize {
namespace {

// One inequality side(x) <= 0 of a constraint, multiplier >= 0.
struct Side {
  VectorX gradient;      // in s = x / range, of what is divided by its scale
  double slack = 0.0;    // >= 0, divided by its scale
  Eigen::Index row = 0;  // of the constraint
  double sign = 0.0;     // +1 at an upper bound, -1 at a lower one
};

// A variable's slack to its bounds, x its range.
struct Room {
  double above = 0.0;  // to the upper bound, >= 0
  double below = 0.0;

  // To the bound that a slope pushes the variable against.
  double against(double slope) const { return slope < 0.0 ? above : below; }
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
  sides.reserve(static_cast<std::size_t>(2 * input.constraint_scale.size()));
  for (Eigen::Index i = 0; i < input.constraint_scale.size(); ++i) {
    const double scale = input.constraint_scale[i];
    const VectorX gradient =
        input.jacobian.row(i + 1).transpose().cwiseProduct(ranges) / scale;
    const double value = input.values[i + 1];
    if (std::isfinite(input.constraint_upper[i])) {
      const double slack = (input.constraint_upper[i] - value) / scale;
      sides.push_back({gradient, std::max(slack, 0.0), i, 1.0});
    }
    if (std::isfinite(input.constraint_lower[i])) {
      const double slack = (value - input.constraint_lower[i]) / scale;
      sides.push_back({-gradient, std::max(slack, 0.0), i, -1.0});
    }
  }
  return sides;
}

std::vector<Room> rooms_of(const FirstOrderInput& input,
                           const VectorX& ranges) {
  std::vector<Room> rooms;
  rooms.reserve(static_cast<std::size_t>(input.x.size()));
  for (Eigen::Index j = 0; j < input.x.size(); ++j) {
    rooms.push_back(
        {.above = std::max((input.upper[j] - input.x[j]) / ranges[j], 0.0),
         .below = std::max((input.x[j] - input.lower[j]) / ranges[j], 0.0)});
  }
  return rooms;
}

// Multiplier of the bound that holds against the slope r of a variable:
// min over m >= 0 of (r + m)^2 + (m room)^2 at the upper bound, of
// (r - m)^2 + (m room)^2 at the lower one. Positive at the upper.
double bound_multiplier(double r, const Room& room) {
  const double slack = room.against(r);
  return -r / (1.0 + slack * slack);
}

// What is then left of r^2.
double weight(double r, const Room& room) {
  const double slack = room.against(r);
  return slack * slack / (1.0 + slack * slack);
}

// Multipliers of the sides, those of the bounds put in by their formula: the
// weights depend on the signs of the slopes, and the slopes on the multipliers.
VectorX side_multipliers(const std::vector<Side>& sides,
                         const std::vector<Room>& rooms,
                         const VectorX& slopes) {
  constexpr int kRounds = 30;
  const Eigen::Index n = slopes.size();
  const auto count = static_cast<Eigen::Index>(sides.size());
  VectorX best = VectorX::Zero(count);
  double least = std::numeric_limits<double>::infinity();
  VectorX r = slopes;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + count, count);
    VectorX b = VectorX::Zero(n + count);
    VectorX root(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      root[j] = std::sqrt(weight(r[j], rooms[static_cast<std::size_t>(j)]));
    }
    b.head(n) = -root.cwiseProduct(slopes);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Side& side = sides[static_cast<std::size_t>(k)];
      A.col(k).head(n) = root.cwiseProduct(side.gradient);
      A(n + k, k) = side.slack;
    }
    // Nonnegative least squares [lawson1974].
    const VectorX multipliers = quadratic::nonnegative_least_squares(A, b);
    r = slopes;
    double cost = 0.0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Side& side = sides[static_cast<std::size_t>(k)];
      r += multipliers[k] * side.gradient;
      cost += std::pow(multipliers[k] * side.slack, 2);
    }
    for (Eigen::Index j = 0; j < n; ++j) {
      cost += weight(r[j], rooms[static_cast<std::size_t>(j)]) * r[j] * r[j];
    }
    if (!(cost < least)) {
      break;
    }
    least = cost;
    best = multipliers;
  }
  return best;
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
  // sum (m_k g_k)^2, over the constraints and the bounds.
  const std::vector<Side> sides = sides_of(input, ranges);
  const std::vector<Room> rooms = rooms_of(input, ranges);
  const VectorX multipliers = side_multipliers(sides, rooms, gradient / unit);

  FirstOrderReport report;
  // Largest entries of both sums: stationarity and complementarity. Back to
  // the given units; a lower side counts with the other sign.
  report.unit = unit;
  report.violation = violation_of(input);
  report.multipliers = VectorX::Zero(input.constraint_scale.size());
  report.bound_multipliers = VectorX::Zero(n);
  VectorX rest = gradient / unit;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Side& side = sides[k];
    const double m = multipliers[static_cast<Eigen::Index>(k)];
    rest += m * side.gradient;
    report.complementarity = std::max(report.complementarity, m * side.slack);
    report.multipliers[side.row] +=
        side.sign * unit * m / input.constraint_scale[side.row];
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const Room& room = rooms[static_cast<std::size_t>(j)];
    const double m = bound_multiplier(rest[j], room);
    report.complementarity =
        std::max(report.complementarity, std::abs(m) * room.against(rest[j]));
    rest[j] += m;
    report.bound_multipliers[j] = unit * m / ranges[j];
  }
  report.stationarity = n == 0 ? 0.0 : rest.cwiseAbs().maxCoeff();
  report.residual = std::max(report.stationarity, report.complementarity);
  return report;
}

}  // namespace meniscus::optimize
