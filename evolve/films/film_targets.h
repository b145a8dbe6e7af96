/// The numbers of a film that change with the design.
#pragma once

#include <algorithm>
#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::films {

/// What is asked of the liquid.
struct FilmTargets {
  std::vector<double> tension;      // one per surface [force/length]; caps 0
  std::vector<ComplexBody> bodies;  // volume or pressure asked; after them one
                                    // per held quantity, its target as volume
  /// The numbers of fields that follow the design: per quantity those of its
  /// scalar or its poles (evolve/energy/pole_field.h), then per surface its
  /// tension_numbers(). Empty: none.
  std::vector<VectorX> numbers;

  /// Of one model, whose numbers are as many.
  bool operator==(const FilmTargets&) const = default;
};

/// Forces of a film are measured by it [force/length]; 0 without surfaces.
inline double largest_tension(const FilmTargets& targets) {
  return targets.tension.empty() ? 0.0
                                 : *std::max_element(targets.tension.begin(),
                                                     targets.tension.end());
}

}  // namespace meniscus::films
