/// Supports and loads on named surfaces, and the weights of a surface.
#pragma once

#include <string>
#include <vector>

#include "core/tet_mesh.h"

namespace meniscus {

/// Fixes components of displacement on a surface.
struct Support {
  std::string surface;
  bool fix_x = false, fix_y = false, fix_z = false;
};

/// A total force spread as uniform traction over a surface [force].
struct SurfaceForce {
  std::string surface;
  Vec3 total = Vec3::Zero();
};

/// Pressure on a surface, positive into the solid [pressure].
struct SurfacePressure {
  std::string surface;
  double pressure = 0.0;
};

struct LoadCase {
  std::string name;
  std::vector<Support> supports;
  std::vector<SurfaceForce> forces;
  std::vector<SurfacePressure> pressures;
  VectorX nodal;  // forces at nodes, 3 per node; empty: none [force]
};

/// Consistent weights of a surface: integral of each node's shape function
/// over it, by the three-point rule (CalculiX's own for C3D10) [length^2].
struct SurfaceWeights {
  std::vector<int> nodes;  // ascending
  VectorX weights;         // one per node; their sum is the surface's area
};

/// Throws InvalidInput for a surface that is unknown, has no faces or no area.
SurfaceWeights surface_weights(const TetMesh& mesh, const std::string& surface);

/// Nodal forces of a load case, 3 per node [force]. Throws InvalidInput for a
/// surface that is unknown or has no area, and for numbers that are not finite.
VectorX nodal_forces(const TetMesh& mesh, const LoadCase& load_case);

/// Area-weighted mean displacement of a surface along `direction` (made unit)
/// [length]. `displacement`: 3 per node.
double mean_displacement(const TetMesh& mesh, const std::string& surface,
                         const Vec3& direction, const VectorX& displacement);

}  // namespace meniscus
