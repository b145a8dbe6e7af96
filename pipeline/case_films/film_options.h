/// How a case's film is frozen.
#pragma once

#include <algorithm>

#include "pipeline/case_data/case.h"

namespace meniscus::case_films {

/// Refinements that give split facets of adaptive meshes their mid-sides.
inline constexpr int kAdaptiveRefinements = 2;

/// Nested refinements from the meshed film to the film's own mesh.
inline int film_refinements(const case_data::Case& input) {
  return input.analysis.adapt
             ? std::max(input.resolution.refinements, kAdaptiveRefinements)
             : input.resolution.refinements;
}

}  // namespace meniscus::case_films
