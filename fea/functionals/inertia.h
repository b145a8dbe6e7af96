/// Moments of inertia as functionals (functional.h).
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/functionals/volume_functionals.h"

namespace meniscus::functionals {

/// Of the moment about an axis, also by what it goes through and along.
struct InertiaFunctional : MassFunctional {
  Vec3 by_axis = Vec3::Zero();   // by the axis as given [value/length]
  Vec3 by_point = Vec3::Zero();  // 0 about the centre of mass [value/length]
};

/// int rho |r|^2 dV, r the distance to the axis along `axis` (any length but 0)
/// through `point`; without one through the centre of mass [mass length^2]. By
/// quadrature of degree five: exact on straight elements, on curved ones to the
/// sixth order. The entry of the inertia tensor that belongs to two axes a, b
/// at right angles is its moment about a + b less half of those about a and b.
/// Throws InvalidInput: check_materials(), an axis of length 0, no mass where
/// the centre is asked for.
InertiaFunctional inertia_functional(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const Vec3& axis, const std::optional<Vec3>& point,
    element::Derivatives derivatives = element::Derivatives::All);

}  // namespace meniscus::functionals
