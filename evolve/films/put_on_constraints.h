/// Vertices onto level sets.
#pragma once

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// A point near `from` that satisfies the level sets of constraint_sets[set],
/// by Newton's method with least-norm steps, to 1e-10 in each formula's unit
/// (to rounding where the level sets are independent); `from` itself when it
/// satisfies them, or for set -1. Throws InvalidInput when there is none
/// nearby or a formula cannot be evaluated.
Vec3 put_on_constraints(const FilmComplex& complex, int set, const Vec3& from);

}  // namespace meniscus::films
