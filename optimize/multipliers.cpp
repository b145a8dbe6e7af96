#include "optimize/multipliers.h"

#include <algorithm>
#include <cmath>

#include "optimize/first_order.h"

namespace meniscus::optimize {
namespace {

constexpr double kConstraintAtBound = 1e-3;  // of its scale
constexpr double kVariableAtBound = 1e-5;    // of its range

FirstOrderInput input_of(const std::vector<Variable>& variables,
                         const MinimizeReport& report) {
  const auto n = static_cast<Eigen::Index>(variables.size());
  const auto m = static_cast<Eigen::Index>(report.constraints.size());
  FirstOrderInput input{.x = report.best,
                        .lower = VectorX(n),
                        .upper = VectorX(n),
                        .ranges = VectorX(n),
                        .values = report.values,
                        .jacobian = report.jacobian,
                        .constraint_lower = VectorX(m),
                        .constraint_upper = VectorX(m),
                        .constraint_scale = VectorX(m),
                        .objective_scale = report.first_order->unit};
  for (Eigen::Index j = 0; j < n; ++j) {
    const Variable& variable = variables[static_cast<std::size_t>(j)];
    const double range = variable.range.value_or(variable.upper -  //
                                                 variable.lower);
    input.lower[j] = variable.lower;
    input.upper[j] = variable.upper;
    // One that is held has no slopes, and any unit does.
    input.ranges[j] = range > 0.0 ? range : 1.0;
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    const ConstraintState& state =
        report.constraints[static_cast<std::size_t>(i)];
    input.constraint_lower[i] = state.lower;
    input.constraint_upper[i] = state.upper;
    input.constraint_scale[i] = state.scale;
  }
  return input;
}

// The bound that a multiplier pushes against, if x stands at it.
std::optional<BindingBound> at_bound(double x, double lower, double upper,
                                     double multiplier, double near) {
  const bool above = multiplier > 0.0;
  const double bound = above ? upper : lower;
  if (!(std::abs(x - bound) <= near)) {
    return std::nullopt;
  }
  return BindingBound{.side = lower == upper ? BoundSide::Both
                              : above        ? BoundSide::Upper
                                             : BoundSide::Lower,
                      .bound = bound,
                      .slope = -multiplier};
}

}  // namespace

const char* name_of(BoundSide side) {
  switch (side) {
    case BoundSide::Lower:
      return "lower";
    case BoundSide::Upper:
      return "upper";
    case BoundSide::Both:
      return "both";
  }
  return "unknown";
}

std::optional<Multipliers> multipliers(const std::vector<Variable>& variables,
                                       const MinimizeReport& report) {
  if (!report.first_order || !report.feasible) {
    return std::nullopt;
  }
  const FirstOrderInput input = input_of(variables, report);
  const FirstOrderReport conditions = first_order(input);
  Multipliers found{.residual = conditions.residual,
                    .stationarity = conditions.stationarity,
                    .complementarity = conditions.complementarity};
  const auto add = [&](std::optional<BindingBound> bound, bool of_variable,
                       Eigen::Index index, double unit) {
    if (!bound) {
      return;
    }
    bound->of_variable = of_variable;
    bound->index = static_cast<std::size_t>(index);
    bound->weight = std::abs(bound->slope) * unit / conditions.unit;
    if (bound->weight > conditions.residual) {
      found.binding.push_back(*bound);
    }
  };
  for (Eigen::Index i = 0; i < input.constraint_scale.size(); ++i) {
    const double scale = input.constraint_scale[i];
    add(at_bound(input.values[i + 1], input.constraint_lower[i],
                 input.constraint_upper[i], conditions.multipliers[i],
                 kConstraintAtBound * scale),
        false, i, scale);
  }
  for (Eigen::Index j = 0; j < input.x.size(); ++j) {
    const double range = input.ranges[j];
    add(at_bound(input.x[j], input.lower[j], input.upper[j],
                 conditions.bound_multipliers[j], kVariableAtBound * range),
        true, j, range);
  }
  std::stable_sort(found.binding.begin(), found.binding.end(),
                   [](const BindingBound& a, const BindingBound& b) {
                     return a.weight > b.weight;
                   });
  return found;
}

}  // namespace meniscus::optimize
