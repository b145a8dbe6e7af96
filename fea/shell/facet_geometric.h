/// Geometric stiffness of a facet under stress, for buckling.
#pragma once

#include "fea/shell/facet_loads.h"
#include "fea/shell/facet_matrices.h"

namespace meniscus::shell {

/// x . K_g x is twice what the stresses under the displacements `u` (free
/// strains of the loads taken out) do on the part of the strains that is of
/// second order in x, its rotation vectors finite: normals turn to exp(theta)
/// n, so that walls which meet at an angle turn alike. Less what pressures at
/// the faces and weight do as normals turn: both keep their direction (spin
/// acts on the surface). The bubble has none. docs/theory.md, Shells.
FacetMatrix facet_geometric(const Facet& facet, const ShellLoads& loads,
                            const FacetLoad& own, const FacetVector& u);

}  // namespace meniscus::shell
