/// Edges flipped and vertices averaged. Deterministic.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::groom {

/// Flips edges of the films where that increases the smallest angle
/// (equiangulation). Returns the number of flips.
enum class FlipRule {
  KeepShape,  // never where the film's shape would change much
  AnglesOnly  // wherever the angles ask for it, as Surface Evolver's `u` does
};
int equiangulate(films::FilmComplex& complex,
                 FlipRule rule = FlipRule::KeepShape);

/// One step of vertex averaging: liquid vertices move to the area-weighted
/// centre of their facets, along the film only; on lines to the middle of
/// their neighbours, along the line only. `marked`: one char per vertex, those
/// that move; empty: all.
void average_vertices(films::FilmComplex& complex,
                      const std::vector<char>& marked = {});

}  // namespace meniscus::groom
