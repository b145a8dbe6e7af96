/// Vector fields whose fluxes and line integrals make terms.
#pragma once

#include <functional>

#include "evolve/energy/film_terms.h"
#include "evolve/energy/radial_field.h"

namespace meniscus::energy {

/// F at a place with its first and second derivatives, up to the order asked.
using FieldFunction = std::function<FieldJet(const Vec3&, JetOrder)>;

FieldFunction expression_field(const films::VectorField& field);

/// Weight: F = -rho (g.x)^2 / (2 |g|^2) g has divergence -rho g.x.
FieldFunction weight_field(double density, const Vec3& g);

/// F = (0, 0, z): columns down to z = 0.
FieldJet column_field(const Vec3& at, JetOrder order);

/// F = x / 3: cones to the origin.
FieldJet cone_field(const Vec3& at, JetOrder order);

}  // namespace meniscus::energy
