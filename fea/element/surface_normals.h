/// Normals of a surface at its nodes.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::element {

struct SurfaceNormals {
  std::vector<int> nodes;      // ascending
  Points normal;               // outward, unit: mean of the faces' by area
  std::vector<double> spread;  // largest |n of a face - mean| at the nodes of
                               // the faces around: how well it is known
};

/// Throws InvalidInput for an unknown surface, and where faces turn their backs
/// on each other so that a node has no normal.
SurfaceNormals surface_normals(const TetMesh& mesh, const std::string& surface);

/// The unit normal of a plane surface. Throws InvalidInput, naming surface and
/// the worst node, where nodes are off the plane by more than 1e-6 of its size.
Vec3 plane_normal(const TetMesh& mesh, const std::string& surface);

}  // namespace meniscus::element
