/// From a start that answers to the best design: restarts in smaller boxes,
/// the augmented Lagrangian, a global method and its polish.
#pragma once

#include "optimize/minimize_evaluator.h"

namespace meniscus::optimize {

struct SearchResult {
  int iterations = 0;
  /// The last run ended by its own tolerance and nothing it did helped.
  bool finished = false;
  /// The search gave up beside points that cannot be evaluated.
  bool walled = false;
  std::string message;  // the library's last word
};

/// Runs until the evaluator halts or nothing better is found; then ask the
/// evaluator for the incumbent. `start` must have answered.
SearchResult search(MinimizeEvaluator& evaluator, const VectorX& start,
                    const std::string& method);

}  // namespace meniscus::optimize
