/// What a mesh and its load cases must be before anything is computed.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/equations/elastic_solution.h"
#include "fea/loads/loads.h"

namespace meniscus::equations {

/// Throws InvalidInput unless the arrays of the mesh fit each other.
void check_arrays(const TetMesh& mesh);

/// Throws SolverError when the free memory is less than the stiffness, its
/// preconditioner and the solve will need: 2.7 kB a node of ten-node elements,
/// 1.7 kB of four-node ones (measured from 20,000 to 640,000 nodes). Of a
/// distributed solve only what this process needs: its processes may have
/// other machines' memory.
void check_memory(const TetMesh& mesh, SolverKind solver);

/// The load case's nodal forces; throws InvalidInput when there are none and no
/// displacement is enforced.
VectorX checked_forces(const TetMesh& mesh, const loads::LoadCase& load_case,
                       const std::vector<element::Material>& materials);

}  // namespace meniscus::equations
