/// Internal to film_solid: how true the faces are to the film.
#pragma once

#include "cad/solid/film_faces.h"
#include "cad/solid/film_solid.h"
#include "core/geometry/facet_tree.h"

namespace meniscus::solid {

/// Adds a film's distances and tangent breaks to the report. `tree`: of the
/// film's own facets in the whole mesh.
void measure_film(const FilmPiece& film, const FilmFaces& faces,
                  const FacetTree& tree, double edge, FilmSolidReport& report);

}  // namespace meniscus::solid
