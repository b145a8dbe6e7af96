/// What few facets leave to gain: vertices that slide along the film to where
/// its facets have less area.
#pragma once

#include "evolve/settle/equilibrium.h"

namespace meniscus::settle {

struct SlideOptions {
  int steps = 200;  // of conjugate gradients
  SettleOptions settle;
};

/// Moves the vertices of a settled film in every direction that walls leave,
/// downhill by conjugate gradients, as Surface Evolver's `g` with `U` does,
/// and settles it again along its normals. The film of a given number of
/// facets then has less energy, by what its facets miss of the smooth film's
/// at the most; the facets' shapes are not looked after. `complex` becomes the
/// film that comes out; it stays as it was where that is none (the state's
/// failure). Throws Interrupted.
FilmState slide_vertices(films::FilmComplex& complex,
                         const SlideOptions& options);

}  // namespace meniscus::settle
