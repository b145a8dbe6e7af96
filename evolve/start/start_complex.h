/// From curves, films and bodies to the first triangles of a film.
#pragma once

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::start {

/// The start complex: curves cut into edges of about `edge`, films as their
/// kind says, caps triangulated in their plane, facets oriented outward of the
/// bodies. Throws InvalidInput: unknown curve or surface, a cap on a curve
/// that is not planar, a branch curve that is off the convex hull (which one),
/// a body that its surfaces do not close (names the open edges' surfaces and
/// position), a surface that encloses nothing.
films::FilmComplex build_start(const films::FilmSystem& system, double edge);

}  // namespace meniscus::start
