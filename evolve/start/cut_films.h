/// Internal to start: films and rings cut by a plane of symmetry.
#pragma once

#include "evolve/films/film_complex.h"
#include "evolve/start/face_loops.h"

namespace meniscus::start {

/// Leaves out the facets beyond the plane, where its normal points to, and cuts
/// those across it. Vertices that are nearer to the plane than to others are
/// put onto it, those of films slide on it, edges in it are marked. Curves keep
/// their vertices: they must have some where they cross. Vertices that no facet
/// has any more stay. Throws InvalidInput, naming the surface, where a film
/// lies along two planes or a ring is cut aslant.
void cut_films(const FacePlane& plane, films::FilmComplex& complex);

}  // namespace meniscus::start
