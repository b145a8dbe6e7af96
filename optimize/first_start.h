/// Where a search begins when the initial point cannot be evaluated.
#pragma once

#include "optimize/evaluator_core.h"

namespace meniscus::optimize {

/// Point `index` of those tried in place of a failed initial one: 1 is the
/// middle of the box, the others spread over it (J. H. Halton, Numer. Math. 2,
/// 1960).
VectorX probe_point(const EvaluatorCore& core, int index);

/// Asks at a point; true: it answered, false: it failed, none: halted.
using AskStart =
    std::function<std::optional<bool>(const VectorX& x, EvaluationPhase)>;

/// The initial point, else the first probe that answers; nothing when none of
/// them does or the search is over.
std::optional<VectorX> find_start(const EvaluatorCore& core,
                                  const AskStart& ask);

/// "no design could be evaluated: ...", with what to change.
std::string no_start_message(const EvaluatorCore& core);

}  // namespace meniscus::optimize
