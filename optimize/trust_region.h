/// Sequential quadratic programming in a trust region that learns from points
/// that cannot be evaluated: slsqp.
#pragma once

#include "optimize/minimize_search.h"

namespace meniscus::optimize {

/// One run from `start`, which has answered. Each step minimises a quadratic
/// model of the Lagrangian (BFGS, damped: M. J. D. Powell, 1978) under the
/// linearised constraints (least squares as in D. Kraft's SLSQP, 1988) within a
/// box of `radius` x the ranges about the best point so far, on this side of
/// points that failed. Constraints that exclude each other there are missed by
/// as little as can be. A step is judged by an exact penalty; where curved
/// constraints spoil it, a second-order correction follows. Ends when the
/// evaluator halts, when steps are shorter than same_design(), or when little
/// is gained for long where points that fail hold it up or constraints are
/// missed.
SearchResult trust_region_run(MinimizeEvaluator& evaluator,
                              const VectorX& start, double radius);

}  // namespace meniscus::optimize
