/// A force and a moment carried by a surface.
#pragma once

#include "fea/loads.h"

namespace meniscus {

/// Nodal forces f_i = w_i (a + b x (x_i - c)), w the surface's weights and c
/// their centre: of all with the given force and moment the least in
/// sum |f_i|^2 / w_i. One per node of `weights` [force]. Throws InvalidInput
/// where the nodes cannot carry a moment (they lie on a line).
Points remote_forces(const TetMesh& mesh, const SurfaceWeights& weights,
                     const RemoteLoad& load);

}  // namespace meniscus
