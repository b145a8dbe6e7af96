/// The invariants of a film complex.
#pragma once

#include "evolve/films/film_complex.h"

namespace meniscus::test_films {

/// Throws MeshError, naming ids, unless every invariant of a complex holds:
/// indices, labels and kinds consistent, no facet twice, vertices on their
/// curves and level sets, marks once per edge, edges with one facet marked or
/// on a curve, two facets of one surface running opposite ways, and each
/// body's facets using every edge as often each way (but for marked edges on
/// walls or above columns, where the rest is integrals), outward.
void check_complex(const films::FilmComplex& complex);

}  // namespace meniscus::test_films
