/// Nodal forces of load cases, and the weights of a surface.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// Consistent weights of surfaces: integral of each node's shape function
/// over them, by the three-point rule (CalculiX's own for C3D10) [length^2].
struct SurfaceWeights {
  std::vector<int> nodes;  // ascending
  VectorX weights;         // one per node; their sum is the area of all
};

/// Throws InvalidInput for a surface that is unknown, has no faces or no area,
/// and for none at all.
SurfaceWeights surface_weights(const TetMesh& mesh, const Surfaces& surfaces);

/// Consistent nodal forces of a load case, 3 per node, those of expansion
/// included [force]. Numbers act by CalculiX's rules (three points a face, the
/// stiffness rule in an element), fields on surfaces by seven points a face.
/// `materials`: one per region, needed where gravity, spin or temperature act.
/// Throws InvalidInput, naming load case and surface: unknown surfaces or ones
/// without area, numbers that are not finite, a material that is missing, has
/// no density under gravity or spin, or no expansion under a temperature.
VectorX nodal_forces(const TetMesh& mesh, const LoadCase& load_case,
                     const std::vector<element::Material>& materials = {});

/// Area-weighted mean displacement of a surface along `direction` (made unit)
/// [length]. `displacement`: 3 per node.
double mean_displacement(const TetMesh& mesh, const std::string& surface,
                         const Vec3& direction, const VectorX& displacement);

}  // namespace meniscus::loads
