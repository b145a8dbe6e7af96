/// Work and energy of a load case as functionals (functional.h).
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::functionals {

/// f(x) . u, f the nodal_forces() of the load case, expansion's included
/// [force length]. Its adjoint is the displacement itself, with the reactions
/// of the solve: no solution is needed. Throws as force_gradient().
element::Functional compliance_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& displacement,
    element::Derivatives derivatives = element::Derivatives::All);

/// strain_energy() (body_loads.h): of the solid without springs, expansion
/// taken out [force length]. Throws InvalidInput as residual_gradient().
element::Functional strain_energy_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const loads::LoadCase& load_case, const VectorX& displacement,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
