/// Least-squares match by Ceres (Levenberg-Marquardt within bounds).
#pragma once

#include "optimize/match_evaluator.h"

namespace meniscus::optimize {

struct BackendResult {
  int iterations = 0;
  Eigen::MatrixXd jacobian;  // last one used, may be empty
  std::string message;       // the library's own last word
};

/// Runs until the evaluator halts or Ceres finds nothing better. `start` must
/// have been evaluated with success. Derivatives: the caller's own, asked at
/// accepted points only, else forward differences, kept up between them by
/// Broyden's rank-one update (C. G. Broyden, Math. Comp. 19, 1965) as long as a
/// step reduces the residual well.
BackendResult ceres_match(MatchEvaluator& evaluator, const VectorX& start);

}  // namespace meniscus::optimize
