/// Whether supports keep a shell from moving as a whole.
#pragma once

#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

/// Throws SolverError, naming a place and the motion, where facets that hang
/// together can move or turn rigidly. A factor may not notice: rounding leaves
/// pivots that are positive.
void check_held(const ShellMesh& mesh, const ShellFreedom& freedom);

}  // namespace meniscus::shell
