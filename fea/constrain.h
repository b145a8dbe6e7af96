/// Oblique supports for solvers that know only fixed degrees of freedom.
#pragma once

#include "fea/block_matrix.h"
#include "fea/node_freedom.h"

namespace meniscus {

/// A becomes P A P + s (I - P), P the projector onto the free directions and s
/// a node's mean diagonal: positive definite where A is on the free directions,
/// and solved by P f to a solution that is free of the held ones.
void constrain(const BlockPattern& pattern, const NodeFreedom& freedom,
               BlockMatrix<double>& matrix);

/// P v for vectors of 3 per node.
VectorX project(const NodeFreedom& freedom, VectorX v);

}  // namespace meniscus
