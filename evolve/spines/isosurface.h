/// Level sets as triangles.
#pragma once

#include <functional>

#include "core/geometry/surface_mesh.h"

namespace meniscus::spines {

/// Where a surface is looked for.
struct Ball {
  Vec3 at = Vec3::Zero();
  double radius = 0.0;  // [length]
};

/// The surface value = 0 in the cells of a cubic lattice that meet one of
/// `balls`, and on from there, but for cells with a corner that `leave_out`
/// names. Cells are cut in six tetrahedra each, so that the surface is a
/// manifold whose border, if any, lies where cells are left out; normals point
/// to where the value is below 0. One label. `cell`: the lattice's step
/// [length], > 0. Throws InvalidInput where there are more than ten million
/// cells, and Interrupted.
SurfaceMesh isosurface(const std::function<double(const Vec3&)>& value,
                       const std::vector<Ball>& balls, double cell,
                       const std::function<bool(const Vec3&)>& leave_out);

}  // namespace meniscus::spines
