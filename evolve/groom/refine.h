/// Every facet into four. Deterministic.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"

namespace meniscus::groom {

/// Nested refinement: every facet into four, by the middles of its edges.
/// Vertices on marked edges and rims are born as the mark says: on curves at
/// the middle parameter, on walls on their level sets, others at the edge's
/// middle; the two halves of a marked edge follow each other in its place,
/// direction kept. Edges with refine = false and those of surfaces with
/// refine = false stay whole, and facets beside them become three or two.
///
/// Multigrid hierarchies rely on the numbering: old vertices come first and
/// keep their numbers, one new vertex per halved edge follows in the order of
/// list_edges (`parents`: the edge's ends); when no edge stays whole, facet f =
/// (0, 1, 2) has the children 4f .. 4f + 3, which are (0, 01, 20),
/// (01, 1, 12), (20, 12, 2) and (01, 12, 20). Linear in time: 245,760 facets
/// in about 0.1 s.
struct Refinement {
  films::FilmComplex complex;
  std::vector<Edge> parents;  // one per new vertex
};
/// Throws InvalidInput where the middle of an edge has no nearest point on the
/// bent wall of its face.
Refinement refine(const films::FilmComplex& complex);

}  // namespace meniscus::groom
