/// Least-squares match where bounds or points that fail stand in the way:
/// Gauss and Newton's method in a trust region within the bounds.
#pragma once

#include "optimize/ceres_match.h"

namespace meniscus::optimize {

/// From `start`, which has answered, until the evaluator halts or nothing
/// better is found. Each step minimises |r + J d| over a box within the bounds,
/// on this side of points that failed (optimize/quadratic/failed_points.h), so
/// that variables at a bound are left out of it and come back when they gain.
/// Ends early where a flat valley gives no visible gain.
BackendResult bounded_match(MatchEvaluator& evaluator, const VectorX& start);

}  // namespace meniscus::optimize
