/// The way of a case's films: designs that they are led through, from those of
/// an earlier run (Case::way) and of earlier models to the case's own.
#pragma once

#include <vector>

#include "evolve/films/film_system.h"
#include "pipeline/case_data/case.h"

namespace meniscus::case_films {

/// Films at values of the design variables, then of the parameters; NaN: what
/// the case itself makes of that parameter.
struct Waypoint {
  VectorX values;
  films::FilmSystem system;
};

/// All of it, in order; the last is that of `inputs`. Throws InvalidInput where
/// the case cannot be evaluated there.
std::vector<Waypoint> film_way(const case_data::Case& input,
                               const case_data::EvaluatedCase& inputs);

/// Half-way between two. Throws InvalidInput as above.
Waypoint waypoint_between(const case_data::Case& input, const Waypoint& a,
                          const Waypoint& b);

}  // namespace meniscus::case_films
