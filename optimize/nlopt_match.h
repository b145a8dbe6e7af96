/// Least-squares match by the derivative-free methods of NLopt.
#pragma once

#include "optimize/ceres_match.h"

namespace meniscus::optimize {

/// The names of the methods, as a case file writes them, by alphabet; those of
/// nlopt_traits() that serve a match.
const std::vector<std::string>& nlopt_match_methods();

/// Minimises |r|^2 / 2 until the evaluator halts or NLopt is done. A failed
/// point counts as twice the largest cost seen: finite, so that methods with a
/// model of the function survive it. `method` is one of the names above.
BackendResult nlopt_match(MatchEvaluator& evaluator, const VectorX& start,
                          const std::string& method);

}  // namespace meniscus::optimize
