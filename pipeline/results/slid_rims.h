/// Rims of films that slid on walls, as curves where they came to rest.
#pragma once

#include "evolve/films/film_system.h"
#include "evolve/frozen/film_model.h"

namespace meniscus::results {

/// The system held where its films rest in `model`: the curves that films slid
/// from are splines through their rims, walls are caps. The same system where
/// nothing slides. Throws InvalidInput, naming the solid, for a wetted face
/// with holes, whose rims could be taken for each other.
films::FilmSystem held_where_it_slid(films::FilmSystem system,
                                     const frozen::FilmModel& model);

}  // namespace meniscus::results
