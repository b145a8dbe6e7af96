/// Walls that end flush, in the plane of a curve, instead of square to their
/// films: feet on a floor.
#pragma once

#include <vector>

#include "evolve/curves/curve.h"
#include "evolve/walls/wall_spec.h"
#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// The unit normal of the curve's plane, either way. Throws InvalidInput for a
/// curve of no plane.
Vec3 flush_normal(const curves::Curve& curve);

/// Planes of the curves at which walls are to be flush (WallSpec::flush), in
/// which points of the films that are on them stay. As long as the curve's
/// plane does not turn with the design that is exact. Throws InvalidInput for a
/// film that lies in the plane, or nearly.
void add_flush_planes(const std::vector<curves::Curve>& curves,
                      const std::vector<WallSpec>& walls, WallFilms& films);

}  // namespace meniscus::walls
