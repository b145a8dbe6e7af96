/// Fills loops on a cylinder, sphere or cone with triangles.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"
#include "evolve/films/bent_wall.h"

namespace meniscus::start {

/// Where a sphere's face is seen from to lie in a plane: the direction from the
/// center [unit length] whose opposite is outside the face. `side`: +1 where
/// the loops run counter-clockwise around the face seen from outside, -1
/// clockwise, 0 where the loops do not tell: of one loop it is then the smaller
/// part.
Vec3 pole_of_face(const films::BentWall& sphere,
                  const std::vector<Points>& loops, double side);

/// Isotropic triangles of about `edge` [length] on the wall between closed
/// loops that lie on it: their points come first, in order, no other lies on
/// them, and facets run along the first in its direction, or along the one
/// around the others. A face within one loop around a cone has its apex for a
/// vertex. `side` as for pole_of_face(). Throws MeshError for loops that cross,
/// InvalidInput for those that bound no face there.
SurfaceMesh fill_bent_face(const films::BentWall& wall,
                           const std::vector<Points>& loops, double side,
                           double edge);

}  // namespace meniscus::start
