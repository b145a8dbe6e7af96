/// Poles of spines as an energy of films: the integral over a body of
///   phi = sum strength (|x - c|^2 + core2)^(-5/2)
/// as the flux, through the body's facets, of
///   F = sum strength / (3 core2) (|x - c|^2 + core2)^(-3/2) (x - c),
/// whose divergence is phi.
#pragma once

#include <memory>

#include "evolve/energy/film_terms.h"
#include "evolve/energy/radial_field.h"
#include "evolve/films/spine_spec.h"

namespace meniscus::energy {

/// The poles as one list of numbers: all x, all y, all z of their places, all
/// strengths, all core2; filled up to a multiple of four poles by poles of no
/// strength.
VectorX pole_numbers(const std::vector<films::Pole>& poles);
/// The same of rates: filled up by zeros.
VectorX pole_rate_numbers(const std::vector<films::Pole>& rates);

/// F at a place, of `numbers` as above.
FieldJet pole_field(Numbers numbers, const Vec3& at, JetOrder order);

/// Its flux through the elements of a term that has the numbers of the poles.
/// Of poles far from a facet fewer of its places count: which are far is found
/// from `mesh` and `poles` as they are and stays, so that the sum is smooth.
std::unique_ptr<FilmTerm> pole_term(
    const SurfaceMesh& mesh, const std::vector<films::Pole>& poles,
    const std::vector<FilmTerm::Element>& elements);

}  // namespace meniscus::energy
