/// How far a part is from yielding.
#pragma once

#include <vector>

#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// Yield strength over von Mises stress where it is least; infinite where no
/// material has a yield strength or there is no stress.
struct SafetyFactor {
  double smallest = 0.0;
  Vec3 position = Vec3::Zero();  // [length]
  int region = 0;
  double von_mises = 0.0;  // there [pressure]
};

/// Of elements that are not excluded (one char per element, or empty), by both
/// readings of a stress: recovered at nodes and as it stands at integration
/// points. Where a mesh resolves a peak the recovered one is the larger and
/// nearer to the truth; where it does not, recovery smooths what the points
/// say (docs/verification.md, Readings of a peak), and the larger of the two is
/// on the safe side. All of one mesh and solution. Throws InvalidInput where
/// materials do not fit the mesh.
SafetyFactor safety_factor(const TetMesh& mesh,
                           const std::vector<element::Material>& materials,
                           const RecoveredStress& recovered,
                           const element::PointStress& points,
                           const std::vector<char>& excluded = {});

/// The largest von Mises stress of three readings, of elements that are not
/// excluded [pressure].
struct PeakReadings {
  double recovered = 0.0;  // at nodes, by patches (patch_recovery.h)
  double averaged = 0.0;   // at nodes, means of extrapolations (stress.h)
  double points = 0.0;     // at integration points
};
PeakReadings peak_readings(const TetMesh& mesh,
                           const RecoveredStress& recovered,
                           const element::PointStress& points,
                           const std::vector<char>& excluded = {});

}  // namespace meniscus::stress
