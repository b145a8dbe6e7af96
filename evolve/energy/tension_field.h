/// Tension that varies with position.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/films/film_targets.h"

namespace meniscus::energy {

/// One per surface [force/length]: its tension in `targets`; of a tension field
/// the mean over the film's vertices at `points`. Throws InvalidInput, naming
/// film, value and place, where a field has no value or one that is not above
/// 0.
std::vector<double> tensions_at(const films::FilmComplex& complex,
                                const films::FilmTargets& targets,
                                const Points& points);

}  // namespace meniscus::energy
