/// What acts on one facet: the shell's loads facet by facet.
#pragma once

#include <array>
#include <vector>

#include "fea/shell/facet_matrices.h"
#include "fea/shell/shell_loads.h"

namespace meniscus::shell {

/// Weight or spin.
bool has_mass_loads(const ShellLoads& loads);

/// Force per mass at a place, of both.
Vec3 acceleration(const ShellLoads& loads, const Vec3& x);

/// What acts along one edge of a facet.
struct EdgeForces {
  double pull = 0.0;  // per length
  Vec3 traction = Vec3::Zero();
  double pressure = 0.0;

  bool acts() const {
    return pull != 0.0 || pressure != 0.0 || traction != Vec3::Zero();
  }
};

/// Pressures and forces along edges of one facet.
struct FacetLoad {
  double negative = 0.0;
  double middle = 0.0;
  double positive = 0.0;
  std::array<EdgeForces, 3> edges = {};

  bool presses() const;
  bool pulls() const;
};
/// One per facet. Throws InvalidInput for facets and edges that are not there.
std::vector<FacetLoad> facet_loads(const ShellMesh& mesh,
                                   const ShellLoads& loads);

/// Free strains of a facet under the loads.
WallState wall_state(const ShellLoads& loads, const FacetLoad& own);

/// What acts on one facet but edges and nodes: consistent, the bubble's moments
/// last.
WholeVector facet_forces(const Facet& facet, const ShellLoads& loads,
                         const FacetLoad& own);

}  // namespace meniscus::shell
