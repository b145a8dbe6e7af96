/// How far two films keep apart, as a smooth response.
#pragma once

#include "core/geometry/surface_mesh.h"
#include "evolve/frozen/film_gradient.h"

namespace meniscus::frozen {

/// -(1/k) ln sum exp(-k d) [length] over the edges of both films, d being the
/// shortest line from an edge to the other film's facets, k = 1 / smoothing:
/// below the least distance of any two facets (corners to facets and edges to
/// edges make all of it), by no more than smoothing x ln(edges). Derivatives
/// are those of d at fixed ends of its line, which are exact wherever the line
/// is one (d is continuous; where two are equally short its slope jumps).
///
/// `film`, `other`: labels of the mesh. Throws InvalidInput for a smoothing
/// that is not above 0, for one film twice, for films without facets, for films
/// that share a vertex, and, with the place, for films that cross: facets are
/// judged by exact signs (core/geometry/facet_pairs.h).
FilmResponse gap_between(const SurfaceMesh& mesh, int film, int other,
                         double smoothing);

}  // namespace meniscus::frozen
