/// Facets of even size. Deterministic.
#pragma once

#include <functional>

#include "core/types.h"
#include "evolve/films/film_complex.h"

namespace meniscus::groom {

/// Isotropic remeshing of the films towards an edge length: split above 4/3,
/// collapse below 4/5, flip towards Delaunay, vertex averaging along the film.
/// Triple lines and liquid marked edges stay lines with their films and marks,
/// remeshed along themselves; walls and curves are kept to; rims, solid
/// surfaces, refine = false and the points where lines meet are not touched
/// (evolve/groom/surface_editor.h says when). Volumes change slightly; settle
/// again afterwards. Throws InvalidInput for a length that is not above 0.
struct RemeshOptions {
  double edge = 0.0;  // [length], > 0
  int passes = 5;
  /// Length wanted at a place [length -> length], > 0; replaces `edge`. Should
  /// change by less than about half its value within its value.
  std::function<double(const Vec3&)> edge_field = {};
};
void remesh_films(films::FilmComplex& complex, const RemeshOptions& options);

}  // namespace meniscus::groom
