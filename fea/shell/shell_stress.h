/// Stresses of a solved shell at both faces and in the middle of the wall.
#pragma once

#include <array>
#include <vector>

#include "fea/element/stress_measures.h"
#include "fea/shell/facet_rule.h"
#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Along x y z [pressure]. At the faces in the outer plies, with the pressures
/// there along the normal; in the ply in the middle with transverse shears of
/// 3/2 their mean, as the parabola of a homogeneous wall has.
struct WallStress {
  element::Stress negative, middle, positive;
};

/// At a facet's six nodes: linear through three points inside, where strains of
/// quadratic facets are of one order more (Barlow, Int. J. Numer. Methods Eng.
/// 10, 1976).
using FacetStress = std::array<WallStress, kNodes>;

/// `displacement`: 6 per node, the solution under `loads` (whose temperature
/// counts). One per facet; the same bits for any number of threads. Throws
/// MeshError and InvalidInput as ShellSystem does.
std::vector<FacetStress> shell_stress(const ShellMesh& mesh,
                                      const std::vector<Section>& sections,
                                      const ShellLoads& loads,
                                      const VectorX& displacement);

/// Means over the facets at each node that lie in one smooth surface there: of
/// those whose normals turn less than `fold` from the facet's own [rad]. As
/// shell_stress() returns them.
std::vector<FacetStress> averaged_stress(const ShellMesh& mesh,
                                         const std::vector<FacetStress>& stress,
                                         double fold = 0.35);

}  // namespace meniscus::shell
