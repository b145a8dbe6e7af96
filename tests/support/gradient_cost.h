/// Seconds of a gradient beside those of evaluations.
#pragma once

#include <string>

namespace meniscus {

struct GradientCost {
  int unknowns = 0;
  double cold = 0.0;      // freezing the model and its first evaluation [s]
  double next = 0.0;      // evaluating a design that is 1 % away [s]
  double gradient = 0.0;  // of the first response at that design [s]
};

/// The least of `runs` wall clock times each; all variables move by 1 %.
/// Throws std::runtime_error when a stage fails.
GradientCost gradient_cost(const std::string& case_text, int runs);

}  // namespace meniscus
