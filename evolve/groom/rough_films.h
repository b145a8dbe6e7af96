/// Facets that a film can no longer be told from: thin ones, and folds.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::groom {

/// Per vertex: is it of a facet with an angle below 10 degrees, or of two
/// facets of a film that turn by more than 60 degrees from one to the other,
/// lines left out? Empty where there is none.
std::vector<char> rough_vertices(const films::FilmComplex& complex);

enum class EvenOut {
  Flips,     // edges are flipped too, everywhere
  KeepEdges  // vertices move alone, near the rough ones: refinements stay
             // nested
};

/// Averages while the films are rough, a few times at most; where they meet
/// their curves steeply on few facets they stay so. False where nothing was
/// rough. Deterministic.
bool even_out(films::FilmComplex& complex, EvenOut how);

}  // namespace meniscus::groom
