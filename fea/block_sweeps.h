/// Gauss-Seidel sweeps over a symmetric block matrix of which only the lower
/// half is stored. A sweep gathers from the rows' blocks and scatters through
/// their transposes in one pass over the matrix.
#pragma once

#include "fea/block_matrix.h"

namespace meniscus {

/// L: blocks below the diagonal, as in BlockMatrix; inverse: inverses of the
/// diagonal blocks, 9 a node, zero in fixed components.
struct SweepMatrix {
  const BlockPattern* pattern;
  const float* lower;
  const float* inverse;
};

/// x_i = D_i^-1 (r_i - (L x)_i - (U x)_i), i ascending, for K interleaved
/// vectors. `upper`: U x on entry; U times the change of x on return, which is
/// minus the residual.
template <int K>
void sweep_forward(const SweepMatrix& matrix, const float* r, float* x,
                   float* upper);

/// The same, i descending, which is the adjoint. `upper`: zero on entry, U x on
/// return.
template <int K>
void sweep_backward(const SweepMatrix& matrix, const float* r, float* x,
                    float* upper);

}  // namespace meniscus
