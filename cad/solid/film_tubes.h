/// Internal to cut_film: a film as tubes, one to each of its rims.
#pragma once

#include "cad/solid/film_splitter.h"

namespace meniscus::solid {

/// A tube's loops: on its rim, and the other.
struct Tube {
  std::vector<int> bottom;
  std::vector<int> top;
};

struct Tubes {
  SplitFilm split;
  std::vector<Tube> tubes;
  std::vector<int> nodes;  // where three tubes meet
};

std::vector<int> facets_of(const SplitFilm& split, int cell);
std::vector<Triangle> corners_of(const FilmMesh& mesh,
                                 const std::vector<int>& facets);
int count_in(const std::vector<int>& some, const std::vector<int>& all);

/// The film refined until its cuts can be smooth, and cut into tubes: one
/// between two rims, else one to each. Throws MeshError, also for more than 48
/// rims.
Tubes film_tubes(FilmMesh mesh, const std::vector<FilmRim>& rims);

}  // namespace meniscus::solid
