/// Facets of faces that films wet on bent walls. Their area is that of the wall
/// behind them, between the lines over their edges, and so is what they bound:
/// both depend on the face's rim alone, as on a plane, and facets inside it
/// neither pull nor fold.
#pragma once

#include <memory>

#include "evolve/energy/film_terms.h"
#include "evolve/films/bent_wall.h"

namespace meniscus::energy {

/// Area [length^2] of the facets of a surface, of which `side` is +1 where
/// their normals point out of the wall's inside, else -1. Cylinder and cone
/// unrolled, of a sphere by its spherical triangles (Van Oosterom, Strackee
/// 1983).
std::unique_ptr<FilmTerm> bent_area_term(const films::BentWall& wall,
                                         double side);

/// What is between the facets and the wall [length^3], above 0 where their
/// normals point to it.
std::unique_ptr<FilmTerm> bent_lens_term(const films::BentWall& wall);

}  // namespace meniscus::energy
