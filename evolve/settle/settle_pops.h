/// Films on past junctions that none keeps.
#pragma once

#include "evolve/settle/find_equilibrium.h"

namespace meniscus::settle {

/// Pops the junctions of a film that find_equilibrium() found with `options`
/// (evolve/groom/pop.h) and settles what comes out, until there is none left or
/// nothing can be popped: then `state`'s verdict tells. Lines split between the
/// two films with the smallest angle between them, which is towards the lower
/// of the films beside an X. Lines keep their ends: FilmUnstable where one is
/// on a wall. `complex` becomes the settled film; deterministic.
/// Throws as find_equilibrium().
FilmState settle_pops(films::FilmComplex& complex, FilmState state,
                      const FindOptions& options);

}  // namespace meniscus::settle
