/// What a branch film starts from.
#pragma once

#include <vector>

#include "evolve/films/film_system.h"

namespace meniscus::start {

/// The convex hull of a film's rims less their caps. `points`: of the rims,
/// one after the other in the order of film.curves, counts[r] of each. Rims may
/// lie side by side in one plane. Throws InvalidInput for a curve off the hull
/// (which one, where) and a hull that ends elsewhere than at the curves.
std::vector<Triangle> branch_facets(const films::FilmSpec& film,
                                    const Points& points,
                                    const std::vector<int>& counts);

}  // namespace meniscus::start
