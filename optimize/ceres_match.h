/// Least-squares match by Ceres (Levenberg-Marquardt within bounds).
#pragma once

#include <limits>

#include "optimize/match_evaluator.h"

namespace meniscus::optimize {

struct BackendResult {
  int iterations = 0;
  Eigen::MatrixXd jacobian;  // last one used, may be empty
  std::string message;       // the library's own last word
};

/// Tells when a match has long gained nothing that can be seen.
class GainWatch {
 public:
  explicit GainWatch(const MatchEvaluator& evaluator);
  /// To be asked after each step: no visible gain of the best cost for eight
  /// evaluations, and four per variable.
  bool idle();

 private:
  const MatchEvaluator& evaluator_;
  double gained_ = std::numeric_limits<double>::infinity();
  int gained_at_ = 0;
};

/// Runs until the evaluator halts or nothing better is found. `start` must
/// have been evaluated with success. Derivatives: the caller's own, asked at
/// accepted points only, else forward differences, kept up between them by
/// Broyden's rank-one update (C. G. Broyden, Math. Comp. 19, 1965) as long as a
/// step reduces the residual well. Ceres' steps know no bounds, are cut off
/// there and creep, and failed points are nothing to it but a reason to halve:
/// from the first of either on bounded_match() takes over.
BackendResult ceres_match(MatchEvaluator& evaluator, const VectorX& start);

}  // namespace meniscus::optimize
