/// Rims that lie closer together than their chords are bent.
#pragma once

#include "evolve/films/film_system.h"

namespace meniscus::start {

/// The system with the smooth curves of each disk, film or cap, cut finely
/// enough, by curves::Curve::fineness, that chords of about `edge` [length] do
/// not cross where the curves do not, as seen along the normal of the first.
/// Curves that cross however finely they are cut stay as they were.
films::FilmSystem with_rims_apart(films::FilmSystem system, double edge);

}  // namespace meniscus::start
