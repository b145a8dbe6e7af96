/// What one stress says: invariants, strain, energy. Stress has six
/// components xx yy zz xy yz zx [pressure], strain the same with tensor (not
/// engineering) shears [1].
#pragma once

#include <array>

#include "core/types.h"
#include "fea/element/material.h"

namespace meniscus::element {

using Stress = std::array<double, 6>;
using Strain = std::array<double, 6>;

double von_mises(const Stress& stress);

/// Principal stresses, largest first [pressure].
Vec3 principal_stresses(const Stress& stress);

/// Principal stresses, largest first, and their unit directions (columns, a
/// right-handed frame; each direction's sign is arbitrary but reproducible).
struct PrincipalFrame {
  Vec3 stress;
  Mat3 direction;
};
PrincipalFrame principal_frame(const Stress& stress);

/// Stress of a displacement gradient H_ij = du_i/dx_j.
Stress stress_of_gradient(const Mat3& gradient, const Lame& material);

/// Elastic strain of a stress.
Strain strain_of(const Stress& stress, const Lame& material);

/// a : C^-1 : b; half of it with a = b is the strain energy density
/// [pressure].
double complementary_product(const Stress& a, const Stress& b,
                             const Lame& material);

/// (stress : strain) / 2 [pressure].
double strain_energy_density(const Stress& stress, const Lame& material);

}  // namespace meniscus::element
