/// The outcome of a minimisation in words and figures.
#pragma once

#include "optimize/minimize_search.h"

namespace meniscus::optimize {

/// Fills everything of the report; `constant`: probes found the objective to
/// be the same everywhere.
MinimizeReport finish_report(MinimizeEvaluator& evaluator,
                             const SearchResult& search, bool constant);

}  // namespace meniscus::optimize
