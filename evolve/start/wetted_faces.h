/// Faces that films wet on walls, whose rims slide there.
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

/// 0 on the wall, of slope 1 there [length], over x, y, z: of a plane
/// n . x - n . at with its unit normal n.
Expression formula_of(const films::FilmWall& wall);

/// How far a place is off the wall, above 0 on the side of its normal, outside
/// bent ones [length].
double off_wall(const films::FilmWall& wall, const Vec3& place);

/// The largest off_wall() of curves of this size where films begin to slide:
/// rounding on a plane; a part of the size from a bent wall, to which they are
/// moved [length].
double wall_reach(const films::FilmWall& wall, double size);

/// The first facets of a bent wall's cap, its rims' points first, in order; of
/// a loop on a sphere its smaller part. Throws InvalidInput for a wall without
/// size, a curve that does not lie on it (which one, where), and for rims that
/// bound nothing there.
SurfaceMesh fill_wetted_face(const films::CapSpec& cap,
                             std::vector<Points> rims, double edge);

/// Lets the rims of a wall's cap slide on it. `label`: the cap's surface, whose
/// facets are turned as they stay; `rims`: the vertices of each of its curves,
/// in order. Throws InvalidInput for a wall without a normal or size, a curve
/// that does not lie on it (which one, where) or does not hold one film there.
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
