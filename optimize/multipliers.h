/// What the bounds that hold a minimum are worth: Lagrange multipliers for
/// people, of constraints and variables alike.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "optimize/minimize.h"

namespace meniscus::optimize {

enum class BoundSide { Lower, Upper, Both };  // Both: of an equation
const char* name_of(BoundSide side);          // "lower", "upper", "both"

/// A bound that the minimum stands at.
struct BindingBound {
  bool of_variable = false;  // else of a constraint
  std::size_t index = 0;     // among those of the problem
  BoundSide side = BoundSide::Upper;
  double bound = 0.0;
  /// d minimum / d bound [objective's unit / bound's unit]: of an upper bound
  /// never above 0, of a lower one never below; of an equation either.
  double slope = 0.0;
  /// |slope| x what counts as one unit of the bound, over the objective's
  /// scale [1]; the bounds are in the order of it, largest first.
  double weight = 0.0;
};

struct Multipliers {
  /// As in FirstOrderReport; slopes, as weights, are right to about this.
  double residual = 0.0;
  double stationarity = 0.0;
  double complementarity = 0.0;
  /// Those whose weight is above the residual.
  std::vector<BindingBound> binding;
};

/// By the bounds of `variables`, which are the problem's or, where these held
/// the search near its start, those that count in the end. A constraint within
/// 1e-3 of its scale of a bound, and a variable within 1e-5 of its range,
/// stands at it. None where no derivatives are known at the report's best, or
/// it misses a constraint.
std::optional<Multipliers> multipliers(const std::vector<Variable>& variables,
                                       const MinimizeReport& report);

}  // namespace meniscus::optimize
