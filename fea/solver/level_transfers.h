/// Residuals to the coarser level and corrections back, in single precision.
#pragma once

#include "fea/solver/corner_mesh.h"
#include "fea/solver/smoothed_aggregation.h"

namespace meniscus::solver {

/// coarse = -P^T upper for K vectors of padded layout (block_sweeps.h); the
/// coarse one's padding becomes garbage.
template <int B, int K>
void restrict_motions(const Prolongation& P, const float* upper, float* coarse);

/// x += P e.
template <int B, int K>
void prolong_motions(const Prolongation& P, const float* e, float* x);

/// coarse = -factor P^T upper, where P interpolates linearly along edges.
template <int K>
void restrict_corners(const CornerMap& map, float factor, const float* upper,
                      float* coarse);

/// x += P e.
template <int K>
void prolong_corners(const CornerMap& map, const float* e, float* x);

}  // namespace meniscus::solver
