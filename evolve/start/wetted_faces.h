/// Faces that films wet on plane walls, whose rims slide there.
///
/// While a film is found its rims may go far, and grooming splits and collapses
/// their edges. The faces behind them are then left out: what they add to the
/// energy and to volumes stands in line integrals along the rims, which on a
/// plane are exact (Stokes), as Surface Evolver has it. Afterwards they are
/// filled again, for all that is made of the closed surface.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::start {

/// n . x - n . at of the wall's unit normal n [length], over x, y, z.
Expression plane_formula(const films::PlaneWall& wall);

/// Lets the rims of a wall's cap slide on it. `label`: the cap's surface, whose
/// facets are turned as they stay; `rims`: the vertices of each of its curves,
/// in order. Throws InvalidInput for a wall without a normal, a curve that does
/// not lie in it (which one, where) or does not hold one film there.
void slide_on_wall(const films::FilmSystem& system, const films::CapSpec& cap,
                   int label, const std::vector<std::vector<int>>& rims,
                   films::FilmComplex& complex);

bool has_wetted_faces(const films::FilmComplex& complex);

/// The complex without wetted faces, their line integrals instead. Vertices are
/// numbered anew; the same complex where there are none.
films::FilmComplex open_wetted_faces(const films::FilmComplex& complex);

/// Fills the faces of an opened complex again, by triangles of about `edge`
/// [length]; their vertices come last. Throws InvalidInput, naming the cap, for
/// a rim that crosses itself.
void close_wetted_faces(films::FilmComplex& complex, double edge);

}  // namespace meniscus::start
