/// Internal to film_terms: the kinds of terms.
#pragma once

#include <memory>

#include "evolve/energy/term_fields.h"

namespace meniscus::energy {

/// Integral of F . n over facets.
std::unique_ptr<FilmTerm> flux_term(FieldFunction field);

/// Integral of a field over facets.
std::unique_ptr<FilmTerm> scalar_term(PlaceField scalar);

/// Integral of a field over what facets enclose, or cones to `origin`.
std::unique_ptr<FilmTerm> body_term(PlaceField scalar,
                                    const films::RayOrigin& origin);

/// Integral of F . dl along edges, with so many Gauss points.
std::unique_ptr<FilmTerm> line_term(FieldFunction field, int points);

/// Energy of the gap between edges and a convex wall (FilmComplex's
/// gap_constant).
std::unique_ptr<FilmTerm> gap_term(Expression formula, double constant);

}  // namespace meniscus::energy
