/// Geometric stiffness of a facet under stress, for buckling.
#pragma once

#include "fea/shell/facet_loads.h"
#include "fea/shell/facet_matrices.h"

namespace meniscus::shell {

/// x . K_g x is the integral over the wall of S_ij d_i U . d_j U, S the
/// stresses in the surface under the displacements `u` (and free strains of the
/// loads), U = x's displacement + zeta its rotation x n. Of what is of second
/// order in a finite turn of the normal nothing: exact for walls that are
/// stretched before they buckle, not bent. The bubble has none.
FacetMatrix facet_geometric(const Facet& facet, const ShellLoads& loads,
                            const FacetLoad& own, const FacetVector& u);

}  // namespace meniscus::shell
