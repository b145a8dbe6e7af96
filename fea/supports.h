/// Fixed degrees of freedom, and whether they hold the body.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/load_case.h"

namespace meniscus {

/// One flag per degree of freedom, 3 per node: 1 where a support of the load
/// case fixes it. Throws InvalidInput for an unknown surface and when nothing
/// is fixed.
std::vector<char> fixed_dofs(const TetMesh& mesh, const LoadCase& load_case);

/// Throws SolverError when a connected part of the mesh can move rigidly
/// although `fixed` is held: the six rigid motions, restricted to the fixed
/// degrees of freedom, must have full rank. The message names the motion.
void check_held(const TetMesh& mesh, const std::vector<char>& fixed,
                const std::string& load_case);

}  // namespace meniscus
