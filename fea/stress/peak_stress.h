/// The largest von Mises stress of a part by three readings, and how far it is
/// from yielding.
#pragma once

#include <vector>

#include "fea/stress/exclusion_zones.h"
#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// One solution's stress, read in three ways; all of one mesh, on loan.
struct StressReadings {
  const TetMesh& mesh;
  const RecoveredStress& recovered;    // at nodes, by patches
  const RecoveredStress& averaged;     // at nodes (average_extrapolations())
  const element::PointStress& points;  // at integration points
};

/// A largest von Mises stress and where it is.
struct Peak {
  double von_mises = 0.0;        // [pressure]
  Vec3 position = Vec3::Zero();  // [length]
  int region = 0;
};

/// Of what is not excluded, and of an element's own region: what another region
/// has at a shared node does not count.
Peak peak_of(const TetMesh& mesh, const RecoveredStress& stress,
             const Excluded& excluded = {});

struct PeakReadings {
  Peak recovered;
  Peak averaged;
  Peak points;

  const Peak& largest() const;
};
PeakReadings peak_readings(const StressReadings& stress,
                           const Excluded& excluded = {});

/// True where the material is one element thick: of the elements of that region
/// around the corner node nearest to `position`, and of their neighbours, none
/// has a corner inside. Linear strains then bend through the whole thickness,
/// and a peak may be further off than other meshes of such elements tell.
bool one_element_through(const TetMesh& mesh, const Vec3& position, int region);

/// Yield strength over von Mises stress where it is least; infinite where no
/// material has a yield strength or there is no stress.
struct SafetyFactor {
  double smallest = 0.0;
  Vec3 position = Vec3::Zero();  // [length]
  int region = 0;
  double von_mises = 0.0;  // there [pressure]
};

/// By whichever reading is worst. On fine meshes recovery is nearest to the
/// truth and seldom below it; on coarse ones, where a patch holds much of a
/// wall's bend, it smooths a peak by up to a tenth, and the averages are
/// nearest (docs/verification.md, Readings of a peak). Throws InvalidInput
/// where materials do not fit the mesh.
SafetyFactor safety_factor(const StressReadings& stress,
                           const std::vector<element::Material>& materials,
                           const Excluded& excluded = {});

}  // namespace meniscus::stress
