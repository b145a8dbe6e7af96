/// Nodal stresses as means of what the elements around say.
#pragma once

#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// Means of element extrapolations at nodes, weighted by volume, each region's
/// own. Ten-node elements: from the four points of the stiffness rule linearly
/// to the corners, mid-sides the mean of their ends; as CalculiX does. One
/// order less accurate than patch recovery, and never far from what the points
/// say.
RecoveredStress average_extrapolations(const TetMesh& mesh,
                                       const element::PointStress& points);

/// Its transpose, as transpose_patches(): `by_value` per copy of `averaged`.
void transpose_averages(const RecoveredStress& averaged,
                        const element::PointStress& points,
                        const std::vector<element::Stress>& by_value,
                        element::PointCovector& by);

}  // namespace meniscus::stress
