/// Pressures on single faces of elements, which need no surface's name.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::loads {

/// Pressure on a face, inner ones too, positive into the element.
struct FacePressure {
  int element = 0;
  int opposite_corner = 0;  // 0 to 3: the corner that the face has not
  double pressure = 0.0;    // [pressure]
};

/// Their consistent nodal forces, 3 per node, by the three points of
/// nodal_forces() [force]. Throws InvalidInput for an element or corner that
/// the mesh has not, and for a pressure that is not finite.
VectorX face_pressure_forces(const TetMesh& mesh,
                             const std::vector<FacePressure>& pressures);

}  // namespace meniscus::loads
