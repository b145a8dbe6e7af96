/// Small named shapes that many tests use.
#pragma once

#include <functional>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"

namespace meniscus::shapes {

/// Axis-aligned box from the origin to `size`, each face cut into n x n
/// squares of two triangles; labels x0 x1 y0 y1 z0 z1; closed, outward.
SurfaceMesh box(const Vec3& size, int n);

/// Icosahedron refined `levels` times onto the sphere; label "sphere".
SurfaceMesh sphere(double radius, int levels);

/// Cubes of edge 1 / `n` x n squares a face, at integer places 0 .. count - 1;
/// `body_at` names each cube's body, -1 for none. Facets lie wherever bodies
/// differ and point out of the lower body number; labels "outside" and "inside"
/// (between two bodies).
SurfaceMesh cubes(const std::array<int, 3>& count, int n,
                  const std::function<int(int, int, int)>& body_at);

/// Box of nx x ny x nz cells, six tetrahedra a cell (conforming), order 1;
/// labels x0 x1 y0 y1 z0 z1.
TetMesh brick(const Vec3& size, int nx, int ny, int nz);

/// Ten-node mesh with straight sides from a four-node one.
TetMesh straight_quadratic(const TetMesh& linear);

/// The same connectivity with inner and boundary nodes moved by a smooth
/// map, for distorted patch tests; boundary labels stay.
TetMesh sheared(const TetMesh& mesh, double amount);

}  // namespace meniscus::shapes
