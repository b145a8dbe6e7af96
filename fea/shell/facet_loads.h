/// What acts on one facet: the shell's loads facet by facet.
#pragma once

#include <array>
#include <memory>
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
  std::shared_ptr<const FacetFields> fields;  // null: none

  bool presses() const;
  bool pulls() const;
};
/// One per facet. Throws InvalidInput for facets and edges that are not there.
std::vector<FacetLoad> facet_loads(const ShellMesh& mesh,
                                   const ShellLoads& loads);

/// Free strains of a facet under the loads; `own` is kept by reference.
WallStates wall_states(const ShellLoads& loads, const FacetLoad& own);

/// Pressures on its negative face, in the middle and on the positive face.
struct FacePressures {
  double negative, middle, positive;
};
FacePressures pressures_at(const FacetLoad& own, const FacetPoint& p);

/// Derivatives by fields as derivatives by the nodes' places, 3 per node; with
/// those that `by_places` has. Throws InvalidInput, naming the place, for a
/// field that has no gradient there.
void add_field_slopes(const Facet& facet, const FacetLoad& own,
                      const ByLoads& by_loads, double* by_places);

/// What acts on one facet but edges and nodes: consistent, the bubble's moments
/// last.
WholeVector facet_forces(const Facet& facet, const ShellLoads& loads,
                         const FacetLoad& own);

}  // namespace meniscus::shell
