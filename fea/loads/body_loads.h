/// Loads that act within the solid: weight, centrifugal force, expansion.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// Adds density (gravity + rate^2 r), r the distance vector from the axis of
/// spin, by the stiffness rule. Throws InvalidInput: see nodal_forces().
void add_body_forces(const TetMesh& mesh, const LoadCase& load_case,
                     const std::vector<element::Material>& materials,
                     VectorX& f);

/// Temperature less its reference at every node; empty when the load case has
/// none [temperature]. Throws InvalidInput where it is not finite.
VectorX temperature_change(const TetMesh& mesh, const LoadCase& load_case);

/// Adds the forces that would give a free body its expansion: B^T C alpha dT.
/// Throws InvalidInput when no material of the mesh expands.
void add_thermal_forces(const TetMesh& mesh, const LoadCase& load_case,
                        const std::vector<element::Material>& materials,
                        VectorX& f);

/// Energy of the elastic strain, expansion taken out, by the stiffness rule
/// [force length]. `temperature_change`: one per node, or empty.
double strain_energy(const TetMesh& mesh,
                     const std::vector<element::Material>& materials,
                     const VectorX& displacement,
                     const VectorX& temperature_change);

}  // namespace meniscus::loads
