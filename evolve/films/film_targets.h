/// The numbers of a film that change with the design.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// What is asked of the liquid.
struct FilmTargets {
  std::vector<double> tension;      // one per surface [force/length]; caps 0
  std::vector<ComplexBody> bodies;  // volume or pressure asked; after them one
                                    // per held quantity, its target as volume
};

}  // namespace meniscus::films
