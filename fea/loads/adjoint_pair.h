/// What the gradient of a state equation is taken between.
#pragma once

#include "core/types.h"

namespace meniscus::loads {

/// A displacement and an adjoint of one load case, 3 numbers per node each; not
/// owned. Reactions as ElasticSolution and AdjointSolution hand them out; they
/// count only where supports hold along normals, which turn with the nodes.
struct AdjointPair {
  const VectorX& displacement;
  const VectorX& reactions;
  const VectorX& lambda;
  const VectorX& adjoint_reactions;
};

}  // namespace meniscus::loads
