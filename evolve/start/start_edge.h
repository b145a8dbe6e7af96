/// How much coarser than its settled film a model's start is.
#pragma once

#include <algorithm>
#include <cmath>

#include "evolve/films/film_system.h"
#include "evolve/films/rim_grading.h"
#include "evolve/start/facet_start.h"

namespace meniscus::start {

/// Halvings of the start's edges on the way to those of a film of `edge`
/// [length]: one, unless the curves' sides are too short for that; of facets
/// that are kept, so many that their mean edge comes nearest to it in ratio.
inline int start_halvings(const films::FilmSystem& system, double edge) {
  if (system.keep_facets) {
    return std::max(0, static_cast<int>(std::lround(
                           std::log2(mean_facet_edge(system) / edge))));
  }
  // Arms around spines need some facets about them.
  const bool thin = std::any_of(
      system.spines.begin(), system.spines.end(), [&](const auto& spine) {
        return std::any_of(spine.radii.begin(), spine.radii.end(),
                           [&](double radius) { return radius < 2.0 * edge; });
      });
  return thin || films::halving_is_too_fine(system, edge) ? 0 : 1;
}

/// The edge length that such a film's start is built at.
inline double start_edge(const films::FilmSystem& system, double edge) {
  return std::ldexp(edge, start_halvings(system, edge));
}

}  // namespace meniscus::start
