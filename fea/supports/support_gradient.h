/// What the turning of held directions adds to an adjoint gradient (internal).
#pragma once

#include "core/geometry/tet_mesh.h"
#include "fea/loads/adjoint_pair.h"
#include "fea/loads/load_case.h"

namespace meniscus::supports {

/// Adds the gradient by node positions of lambda . Q r + r' . Q u, Q the
/// projectors onto held directions, r and r' the supports' reactions to
/// displacement and adjoint: supports along normals turn with their surfaces.
void add_support_gradient(const TetMesh& mesh, const loads::LoadCase& load_case,
                          const loads::AdjointPair& pair, Points& gradient);

}  // namespace meniscus::supports
