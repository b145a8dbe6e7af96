/// How much coarser than its settled film a model's start is.
#pragma once

#include <cmath>

#include "evolve/film_system.h"
#include "evolve/rim_grading.h"

namespace meniscus {

/// Halvings of the start's edges on the way to those of a film of `edge`
/// [length]: one, unless the curves' sides are too short for that.
inline int start_halvings(const FilmSystem& system, double edge) {
  return halving_is_too_fine(system, edge) ? 0 : 1;
}

/// The edge length that such a film's start is built at.
inline double start_edge(const FilmSystem& system, double edge) {
  return std::ldexp(edge, start_halvings(system, edge));
}

}  // namespace meniscus
