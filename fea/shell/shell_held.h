/// Whether supports keep a shell from moving as a whole.
#pragma once

#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

/// The rigid motions that facets which hang together are free to make, one a
/// column, on the unknowns.
Eigen::MatrixXd free_motions(const ShellMesh& mesh,
                             const ShellFreedom& freedom);

/// Throws SolverError, naming a place and the motion, where there are any. A
/// factor may not notice: rounding leaves pivots that are positive.
void check_held(const ShellMesh& mesh, const ShellFreedom& freedom);

}  // namespace meniscus::shell
