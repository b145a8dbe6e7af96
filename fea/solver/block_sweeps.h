/// Gauss-Seidel sweeps over a symmetric block matrix of which only the lower
/// half is stored. A sweep gathers from the rows' blocks and scatters through
/// their transposes in one pass over the matrix.
#pragma once

#include "fea/solver/block_matrix.h"

namespace meniscus::solver {

/// L: blocks below the diagonal, as in BlockMatrix; inverse: (pseudo-)inverses
/// of the diagonal blocks, kLanes<B> numbers a row, the padding zero: held
/// directions are in their null space.
struct SweepMatrix {
  const BlockPattern* pattern;
  const float* lower;
  const float* inverse;
};

/// x_i = D_i^-1 (r_i - (L x)_i), rows in order, from x = 0, for K vectors of
/// padded layout (see multiply). On return `upper` is U x, which is minus the
/// residual. Neither `x` nor `upper` is read.
template <int B, int K>
void sweep_forward(const SweepMatrix& matrix, const float* r, float* x,
                   float* upper);

/// x_i = D_i^-1 (r_i - (L x)_i - (U x)_i) against the order, from any x, which
/// is the adjoint. `upper`: zero on entry, U x on return.
template <int B, int K>
void sweep_backward(const SweepMatrix& matrix, const float* r, float* x,
                    float* upper);

}  // namespace meniscus::solver
