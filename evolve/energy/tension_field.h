/// Tension that is an expression of position.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::energy {

/// One per surface [force/length]: its tension; of a tension field the mean
/// over the film's vertices at `points`. Throws InvalidInput, naming film,
/// value and place, where a field has no value or one that is not above 0.
std::vector<double> tensions_at(const films::FilmComplex& complex,
                                const Points& points);

/// The field, without a value where it is not above 0: there a film would grow
/// for ever, and evaluation throws instead.
Expression positive_only(const Expression& field);

}  // namespace meniscus::energy
