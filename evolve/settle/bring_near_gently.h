/// Internal to find_equilibrium: a second way from a raw film to one that
/// Newton can take, for films that bring_near() tears or leaves folded.
#pragma once

#include <cstddef>

#include "core/monitor.h"
#include "evolve/films/film_complex.h"

namespace meniscus::settle {

struct GentleOptions {
  int refinements = 0;             // of the start that may be made
  std::size_t most_facets = 1500;  // after a refinement
  Monitor* monitor = nullptr;
};

/// From the fat side: bodies are blown up to the volume of their convex hull
/// and let go again, since a film that starts too thin, as one that twists
/// does, shrinks away from the one that is there. On the start and on each of
/// its refinements edges are flipped wherever their angles ask for it, vertices
/// averaged, and the film flows by parts of an edge. No neck stops it: on few
/// facets folds look like one. So it ends near a film or nowhere, and only the
/// verdict on what Newton makes of it counts. Returns how many refinements are
/// left; adds its steps to `steps`. Deterministic. Throws Interrupted, and
/// InvalidInput where a bent wall has no nearest point.
int bring_near_gently(films::FilmComplex& complex, const GentleOptions& options,
                      int& steps);

}  // namespace meniscus::settle
