/// Facets with a small angle, spread anew. Deterministic.
#pragma once

#include "evolve/films/film_complex.h"

namespace meniscus::groom {

/// Averages vertices of the films' facets with an angle below 15 degrees and of
/// the facets around them, along the film. False, and nothing moves, where
/// there is none; else the film is to be settled again.
bool spread_slivers(films::FilmComplex& complex);

}  // namespace meniscus::groom
