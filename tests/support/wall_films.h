/// Films with thickness, from films that share points.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "evolve/walls/wall_model.h"

namespace meniscus {

/// Films that share points closer than 1e-9.
SurfaceMesh joined_films(const std::vector<SurfaceMesh>& films);

/// Films around the y axis at these angles [degree], 1 wide and 2 long, flat at
/// the y axis; each bends away by `rise` at its far side. `n` edges across.
SurfaceMesh film_fan(const std::vector<double>& angles, double rise = 0.0,
                     int n = 8);

/// The films as one wall of about this thickness, halved `levels` times.
walls::WallFilms wall_films_of(SurfaceMesh films, int levels, double thickness);

/// One body of the films at this thickness, halved `levels` times.
walls::ThickWall wall_of(const SurfaceMesh& films, double thickness,
                         int levels);

}  // namespace meniscus
