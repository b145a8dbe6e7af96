/// How loads and stiffness change with the node positions: the part of an
/// adjoint gradient that belongs to the state equation.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/load_case.h"
#include "fea/material.h"

namespace meniscus {

/// A displacement and an adjoint of one load case, 3 numbers per node each; not
/// owned. Reactions as ElasticSolution and AdjointSolution hand them out; they
/// count only where supports hold along normals, which turn with the nodes.
struct AdjointPair {
  const VectorX& displacement;
  const VectorX& reactions;
  const VectorX& lambda;
  const VectorX& adjoint_reactions;
};

/// Gradient by node positions, displacement and adjoint held, of
///   lambda . (f(x) - K(x) u - S(x) u)
/// with all that the load case holds, plus what the turning of held directions
/// adds: dJ/dx in all is a functional's by_nodes plus this. One per node [of
/// lambda . f per length]. The same bits for any number of threads. Throws
/// InvalidInput, naming load case and surface, for a field without a slope
/// (load_case.h) and as nodal_forces() does.
Points residual_gradient(const TetMesh& mesh,
                         const std::vector<Material>& materials,
                         const LoadCase& load_case, const AdjointPair& pair);

/// Gradient of v . f(x) by node positions, f the nodal_forces() of the load
/// case and v (3 per node) held. Throws as residual_gradient().
Points force_gradient(const TetMesh& mesh,
                      const std::vector<Material>& materials,
                      const LoadCase& load_case, const VectorX& v);

}  // namespace meniscus
