/// How loads and stiffness change with the node positions: the part of an
/// adjoint gradient that belongs to the state equation.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/loads/adjoint_pair.h"
#include "fea/loads/load_case.h"

namespace meniscus::elastic {

/// Gradient by node positions, displacement and adjoint held, of
///   lambda . (f(x) - K(x) u - S(x) u)
/// with all that the load case holds, plus what the turning of held directions
/// adds: dJ/dx in all is a functional's by_nodes plus this. One per node [of
/// lambda . f per length]. The same bits for any number of threads. Throws
/// InvalidInput, naming load case and surface, for a field without a slope
/// (load_case.h) and as nodal_forces() does.
Points residual_gradient(const TetMesh& mesh,
                         const std::vector<element::Material>& materials,
                         const loads::LoadCase& load_case,
                         const loads::AdjointPair& pair);

/// Gradient of v . f(x) by node positions, f the nodal_forces() of the load
/// case and v (3 per node) held. Throws as residual_gradient().
Points force_gradient(const TetMesh& mesh,
                      const std::vector<element::Material>& materials,
                      const loads::LoadCase& load_case, const VectorX& v);

}  // namespace meniscus::elastic
