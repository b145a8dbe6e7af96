/// Volume, mass and centre of mass as functionals (functional.h), by exact
/// quadrature on curved elements. None depends on the displacement.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/element/material.h"

namespace meniscus::functionals {

/// Of a number that depends on the densities, too.
struct MassFunctional : element::Functional {
  std::vector<double> by_density;  // per region [value/density]
};

/// mesh_volume() (stress.h) [length^3].
element::Functional volume_functional(
    const TetMesh& mesh,
    element::Derivatives derivatives = element::Derivatives::All);

/// mesh_mass() (stress.h) [mass]. Throws InvalidInput: check_materials().
MassFunctional mass_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    element::Derivatives derivatives = element::Derivatives::All);

/// Component of the centre of mass along `direction` (as given, not made unit;
/// a coordinate for a unit vector) [length]. Throws InvalidInput:
/// check_materials(); no mass.
MassFunctional centre_of_mass_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const Vec3& direction,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
