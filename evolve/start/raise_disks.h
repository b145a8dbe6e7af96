/// Starts of disk films that close a body with a cap or another disk on the
/// same curve: flat ones would enclose nothing.
#pragma once

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::start {

/// Bulges such disks of a start complex: beside a cap towards the tip of the
/// curve's normal, of two disks the first in the body's list that way and the
/// other against it. As high as the body's volume wants, at most as the curve
/// is wide; an eighth of its width where the body has none.
void raise_disks(const films::FilmSystem& system, films::FilmComplex& complex);

}  // namespace meniscus::start
