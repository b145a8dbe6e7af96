/// The films of a model that become walls.
#pragma once

#include <vector>

#include "evolve/frozen/film_model.h"
#include "evolve/walls/wall_spec.h"
#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// `points`: of a state of `model`, which `system` belongs to. Films whose
/// normals face the middle of their rim are turned: how a film starts must not
/// decide where its inside is. A flat one stays as its curve runs.
WallFilms wall_films(const frozen::FilmModel& model,
                     const films::FilmSystem& system, const Points& points,
                     const std::vector<WallSpec>& walls);

}  // namespace meniscus::walls
