/// The smallest radius of a film's curvature, as a smooth response
/// (docs/theory.md, Margins and radii).
#pragma once

#include "evolve/energy/energy.h"
#include "evolve/frozen/film_gradient.h"

namespace meniscus::frozen {

/// p-mean over the films' facets away from rims and lines of the principal
/// curvatures k1, k2, turned over [length]:
///   r = (sum A tr((G' G)^(p/2)) / sum A)^(-1/p),  G = sum n_i g_i',
/// n_i the unit vertex normals of the film itself, g_i the gradients of the
/// facet's linear functions; G's singular values are |k1|, |k2| (after
/// Rusinkiewicz 2004). Above the smallest radius by a factor that falls to 1
/// as `power` grows, where the tightest place is a small part of the film; on
/// a sphere below it by 2^(1/p). `power`: even, 2 to 64. Throws InvalidInput
/// for others, for films on walls and for a film without such a facet, or flat.
FilmResponse film_radius(const energy::FilmEnergy& energy, const Points& points,
                         int power);

}  // namespace meniscus::frozen
