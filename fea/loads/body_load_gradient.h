/// Gradients by node positions of what acts within the solid (internal).
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// Adds the gradient of v . f, f the nodal forces of gravity, spin and
/// expansion. Throws as nodal_forces(), and for a temperature without a slope.
void add_body_load_gradient(const TetMesh& mesh,
                            const std::vector<element::Material>& materials,
                            const LoadCase& load_case, const VectorX& v,
                            Points& gradient);

/// Throws InvalidInput for a temperature field without a slope.
void require_temperature_slope(const LoadCase& load_case);

/// Adds what derivatives by the nodes' temperatures (one per node) become by
/// their positions; nothing without a temperature field.
void add_temperature_slope(const TetMesh& mesh, const LoadCase& load_case,
                           const VectorX& by_temperature, Points& gradient);

}  // namespace meniscus::loads
