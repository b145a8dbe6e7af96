/// How far two films keep apart, as a smooth response.
#pragma once

#include "core/geometry/surface_mesh.h"
#include "evolve/frozen/film_gradient.h"

namespace meniscus::frozen {

/// -(1/k) ln sum exp(-k d) [length] over the vertices of both films, d being
/// the distance of a vertex to the nearest point of the other film, k = 1 /
/// smoothing: below the least distance of a vertex, by no more than smoothing x
/// ln(vertices). Derivatives are those of d at fixed nearest points, which are
/// exact wherever the nearest point is one (d is continuous; where two are
/// equally near its slope jumps).
///
/// `film`, `other`: labels of the mesh. Throws InvalidInput for a smoothing
/// that is not above 0, for one film twice, for films without facets, for films
/// that share a vertex, and, with the place, for films that cross: facets are
/// judged in extended precision (core/geometry/facet_pairs.h).
FilmResponse gap_between(const SurfaceMesh& mesh, int film, int other,
                         double smoothing);

}  // namespace meniscus::frozen
