/// How far a part is from yielding.
#pragma once

#include <vector>

#include "fea/stress/patch_recovery.h"

namespace meniscus::stress {

/// Yield strength over von Mises stress; infinite where a material has no
/// yield strength or there is no stress.
struct SafetyFactors {
  std::vector<double> nodal;  // per node of the mesh: the least of its regions
  double smallest = 0.0;
  int node = 0;  // where, and in which region
  int region = 0;
  double von_mises = 0.0;  // there [pressure]
};

/// Of elements that are not excluded (one char per element, or empty); nodes
/// of none have an infinite factor. `stress` must be of this mesh. Throws
/// InvalidInput where materials do not fit the mesh.
SafetyFactors safety_factors(const TetMesh& mesh,
                             const std::vector<element::Material>& materials,
                             const RecoveredStress& stress,
                             const std::vector<char>& excluded = {});

}  // namespace meniscus::stress
