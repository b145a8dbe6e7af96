/// Internal to film_terms: the kinds of terms.
#pragma once

#include <memory>

#include "evolve/energy/term_fields.h"

namespace meniscus::energy {

/// Integral of F . n over facets; exact for polynomials of `degree`, at most 5:
/// the fewer points, the faster.
std::unique_ptr<FilmTerm> flux_term(FieldFunction field, int degree = 5);

/// Integral of a field over facets, whose areas count by so many spheroids
/// (evolve/energy/facet_size.h). Their numbers follow the field's.
std::unique_ptr<FilmTerm> scalar_term(PlaceField scalar, int spheroids = 0);

/// Integral of a field over what facets enclose, or cones to `origin`.
std::unique_ptr<FilmTerm> body_term(PlaceField scalar,
                                    const films::RayOrigin& origin);

/// Integral of F . dl along edges, with so many Gauss points.
std::unique_ptr<FilmTerm> line_term(FieldFunction field, int points);

/// Energy of the gap between edges and a convex wall (FilmComplex's
/// gap_constant).
std::unique_ptr<FilmTerm> gap_term(Expression formula, double constant);

}  // namespace meniscus::energy
