/// Rims of a complex: the chains of vertices along curves without marked edges.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// Per vertex the next vertex on its curve in the order of t, the last one's
/// being the first; -1 off the curves, and on curves that have marked edges,
/// which say more than the order does.
std::vector<int> rim_neighbours(const FilmComplex& complex);

}  // namespace meniscus::films
