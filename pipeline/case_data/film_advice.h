/// What would help a film that does not stand: tried before it is said.
#pragma once

#include <string>

#include "core/error.h"
#include "core/monitor.h"
#include "pipeline/case_data/case.h"

namespace meniscus::case_data {

/// Whether there is no film, or none that is stable.
bool is_of_films(const Failure& failure);

struct AdviceOptions {
  double edge = 0.0;  // of the films that are tried [length], > 0
  Monitor* monitor = nullptr;
};

/// Other films of the same case, settled at that edge without refinement: more
/// and less of the liquid next to the films that `failure` names, and larger
/// rims. Says which of them stands first, or which were tried in vain and what
/// is left to do; empty for failures that are not of films. The same for the
/// same input: a fixed list, no clock. Throws Interrupted.
std::string tried_advice(const EvaluatedCase& inputs, const Failure& failure,
                         const AdviceOptions& options);

}  // namespace meniscus::case_data
