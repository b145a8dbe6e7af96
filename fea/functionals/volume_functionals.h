/// Volume, mass and centre of mass as functionals (functional.h), by exact
/// quadrature on curved elements. None depends on the displacement.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/element/material.h"

namespace meniscus {

/// Of a number that depends on the densities, too.
struct MassFunctional : Functional {
  std::vector<double> by_density;  // per region [value/density]
};

/// mesh_volume() (stress.h) [length^3].
Functional volume_functional(const TetMesh& mesh,
                             Derivatives derivatives = Derivatives::All);

/// mesh_mass() (stress.h) [mass]. Throws InvalidInput: check_materials().
MassFunctional mass_functional(const TetMesh& mesh,
                               const std::vector<Material>& materials,
                               Derivatives derivatives = Derivatives::All);

/// Component of the centre of mass along `direction` (as given, not made unit;
/// a coordinate for a unit vector) [length]. Throws InvalidInput:
/// check_materials(); no mass.
MassFunctional centre_of_mass_functional(
    const TetMesh& mesh, const std::vector<Material>& materials,
    const Vec3& direction, Derivatives derivatives = Derivatives::All);

}  // namespace meniscus
