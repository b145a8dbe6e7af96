/// What a mesh and its load cases must be before anything is computed.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/loads.h"

namespace meniscus {

/// Throws InvalidInput unless the arrays of the mesh fit each other.
void check_arrays(const TetMesh& mesh);

/// The load case's nodal forces; throws InvalidInput when there are none.
VectorX checked_forces(const TetMesh& mesh, const LoadCase& load_case,
                       const std::vector<Material>& materials);

bool same_supports(const std::vector<Support>& a,
                   const std::vector<Support>& b);

}  // namespace meniscus
