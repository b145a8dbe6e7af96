/// Gradients by node positions of what acts on surfaces (internal).
#pragma once

#include "core/geometry/tet_mesh.h"
#include "fea/loads/load_case.h"

namespace meniscus::supports {

/// Adds the gradient of v . f, f the nodal forces of the load case's forces,
/// pressures, tractions, remote and bearing loads.
void add_surface_load_gradient(const TetMesh& mesh,
                               const loads::LoadCase& load_case,
                               const VectorX& v, Points& gradient);

/// Adds the gradient of -v . S u, S the springs' stiffness.
void add_spring_gradient(const TetMesh& mesh, const loads::LoadCase& load_case,
                         const VectorX& u, const VectorX& v, Points& gradient);

}  // namespace meniscus::supports
