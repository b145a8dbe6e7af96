/// What would help a film that does not stand or meets other surfaces of its
/// body: tried before it is said.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/geometry/mesh_checks.h"
#include "core/monitor.h"
#include "pipeline/case_data/case.h"

namespace meniscus::case_films {

/// Whether there is no film, or none that is stable.
bool is_of_films(const Failure& failure);

struct AdviceOptions {
  double edge = 0.0;    // of the films that are tried [length], > 0
  int refinements = 0;  // of those that stand without
  /// Of the surface that the films close, where they are at rest.
  std::vector<Finding> findings = {};
  Monitor* monitor = nullptr;
};

/// Other films of the same case, settled at that edge and refinement: more
/// and less of the liquid next to the films that `failure` names, volumes on
/// the way to what the first facets between the curves enclose, and larger
/// rims. Says which of them stands first without meeting itself, or which were
/// tried in vain and what is left to do; empty for failures that are neither of
/// films nor of the surface that they close. The same for the same input: a
/// fixed list, no clock. Throws Interrupted.
std::string tried_advice(const case_data::Case& input,
                         const case_data::EvaluatedCase& inputs,
                         const Failure& failure, const AdviceOptions& options);

}  // namespace meniscus::case_films
