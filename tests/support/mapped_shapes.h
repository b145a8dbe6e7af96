/// Structured meshes to be mapped onto curved bodies, mid-side nodes included.
#pragma once

#include <functional>

#include "core/geometry/tet_mesh.h"

namespace meniscus::shapes {

/// Prism over a triangle: nodes carry the coordinates (b, c, w), b and c two
/// barycentric coordinates of the triangle (a = 1 - b - c), w along the prism,
/// all from 0 to 1; n cells along a side, `layers` along w, three tetrahedra a
/// cell (conforming), order 1. Labels a0 b0 c0 (where that coordinate is 0) and
/// w0 w1.
TetMesh triangle_prism(int n, int layers);

/// The mesh with every node moved to map(node).
TetMesh mapped(TetMesh mesh, const std::function<Vec3(const Vec3&)>& map);

/// Inner corners of a four-node mesh within the unit cube moved irregularly by
/// up to `amount`: equal cells flatter errors and their estimates.
TetMesh shaken(TetMesh mesh, double amount);

/// An eighth of a spherical shell of the given radii: triangle_prism() as a
/// curved ten-node mesh, radii spaced geometrically, inner nodes shaken. Labels
/// x0 y0 z0 (the
/// planes), inner, outer.
TetMesh octant_shell(double inner, double outer, int n, int layers);

/// A quarter of a ring about z: brick() of nr x nt x nz cells as a curved
/// ten-node mesh, radii spaced geometrically, inner nodes shaken. Labels inner,
/// outer, y0, x0 (the planes), z0, z1.
TetMesh quarter_ring(double inner, double outer, double height, int nr, int nt,
                     int nz);

}  // namespace meniscus::shapes
