/// Starts of disk films that close a body with a cap or another disk on the
/// same curve: flat ones would enclose nothing.
#pragma once

#include <vector>

#include "evolve/films/film_complex.h"
#include "evolve/films/film_system.h"

namespace meniscus::start {

/// A disk that was bulged: its free vertices, each with the way it went.
struct RaisedDisk {
  int surface = 0;
  std::vector<int> vertices;
  Points moves;
};

/// Bulges such disks of a start complex: beside a cap towards the tip of the
/// curve's normal, of two disks the first in the body's list that way and the
/// other against it. As high as the body's volume wants, at most as the curve
/// is wide; an eighth of its width where the body has none.
std::vector<RaisedDisk> raise_disks(const films::FilmSystem& system,
                                    films::FilmComplex& complex);

/// Turns the bulges of disks about that two bodies share and lie on one side
/// of, as a hollow would beneath the part that it is to go into. Bodies must be
/// oriented; where it returns true, they must be oriented again.
bool turn_shared_disks(const std::vector<RaisedDisk>& raised,
                       films::FilmComplex& complex);

}  // namespace meniscus::start
