/// Nodal stresses as means of what the elements around say.
#pragma once

#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// How elements around a node count in its mean.
enum class MeanWeight {
  Volume,
  Equal  // CalculiX's, which depends on how the mesh is cut
};

/// Means of element extrapolations at nodes, each region's own. Ten-node
/// elements: from the four points of the stiffness rule linearly to the
/// corners, mid-sides the mean of their ends; as CalculiX does. One order less
/// accurate than patch recovery, and never far from what the points say.
RecoveredStress average_extrapolations(const TetMesh& mesh,
                                       const element::PointStress& points,
                                       MeanWeight weight = MeanWeight::Volume);

/// Its transpose, as transpose_patches(): `by_value` per copy of `averaged`.
void transpose_averages(const RecoveredStress& averaged,
                        const element::PointStress& points,
                        const std::vector<element::Stress>& by_value,
                        element::PointCovector& by);

}  // namespace meniscus::stress
