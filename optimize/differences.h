/// Derivatives by one-sided differences, for searches whose function gives
/// none.
#pragma once

#include "optimize/evaluator_core.h"

namespace meniscus::optimize {

struct Neighbour {
  bool halted = false;              // the search is over
  const VectorX* values = nullptr;  // null: the point failed
};
using AskNeighbour = std::function<Neighbour(const VectorX& x)>;

/// d values / d x at x, or nothing once halted. Forward unless that leaves the
/// bounds; where a neighbour fails the other side, then nearer ones; a zero
/// column (the variable rests during this step) when all fail. The points are
/// told to limits().prefetch first, as many as may still be evaluated.
std::optional<Eigen::MatrixXd> one_sided_differences(const EvaluatorCore& core,
                                                     const VectorX& x,
                                                     const VectorX& values,
                                                     const AskNeighbour& ask);

}  // namespace meniscus::optimize
