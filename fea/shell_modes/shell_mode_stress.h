/// At what stress a shell buckles in a mode: ModeStress of fea/modes, of walls.
#pragma once

#include <vector>

#include "fea/modes/mode_shapes.h"
#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Of the solution `u` under `loads`, where its stresses in the surface push
/// the mode `x` on, at all heights in the wall; 6 per node. The same bits for
/// any number of threads. Throws MeshError and InvalidInput as ShellSystem
/// does.
modes::ModeStress mode_stress(const ShellMesh& mesh,
                              const std::vector<Section>& sections,
                              const ShellLoads& loads, const VectorX& u,
                              const VectorX& x);

}  // namespace meniscus::shell
