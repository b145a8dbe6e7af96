/// Do the supports of solid and shell together hold what is tied together?
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/joint/tie_motion.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"
#include "fea/supports/supports.h"

namespace meniscus::joint {

/// `held`: of the solid, springs included; `freedom`: of the shell, of which
/// tied nodes count as free. Throws SolverError, naming the motion and the
/// place, where a connected piece can move rigidly.
void check_held(const TetMesh& solid,
                const std::vector<supports::HeldDirection>& held,
                const shell::ShellMesh& mesh,
                const shell::ShellFreedom& freedom,
                const std::vector<TieRow>& tie);

}  // namespace meniscus::joint
