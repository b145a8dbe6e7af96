/// Planes of symmetry that cut curves (films::FilmWall::cuts): what is left of
/// a start that was built whole.
#pragma once

#include <string>
#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::start {

/// The parameters at which planes of symmetry cut a curve, increasing.
std::vector<double> cuts_of(const films::FilmSystem& system,
                            const curves::Curve& curve);

/// Joins the places at which planes cut the two curves of a ring, which lie
/// next to each other but for the rounding of a match. Throws InvalidInput,
/// naming `ring`, for one that is not its own image.
void match_cuts(const films::FilmSystem& system, const std::string& ring,
                films::RuledBand& band);

/// Cuts films and rings, fills flat disks on cut curves again, and leaves the
/// faces in the planes open: close_wetted_faces() fills them. `complex` is the
/// whole with its walls; the curves have vertices at cuts_of(). Nothing without
/// such planes. Throws InvalidInput, naming it, for a surface that lies beyond
/// a plane, or whose facets are given.
void cut_start(const films::FilmSystem& system, double edge,
               films::FilmComplex& complex);

/// Is some plane one that cuts?
bool has_cuts(const films::FilmSystem& system);

}  // namespace meniscus::start
