/// What lies between a film and its facets.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::solid {

/// Per label, the volume between the smooth film (cad/solid/film_mesh.h) and
/// its flat facets, positive outside of these [length^3]; 0 for the labels that
/// are `flat` (one char each). Second order in the edge length.
std::vector<double> bulge_volumes(const SurfaceMesh& mesh,
                                  const std::vector<char>& flat);

}  // namespace meniscus::solid
