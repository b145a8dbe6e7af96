/// What one stress says: invariants, strain, energy. Stress has six
/// components xx yy zz xy yz zx [pressure], strain the same with doubled shears
/// (gamma) [1].
#pragma once

#include <array>
#include <vector>

#include "core/types.h"
#include "fea/elastic_law.h"

namespace meniscus {

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
Stress stress_of_gradient(const Mat3& gradient, const ElasticLaw& law);

/// Strain = compliance x stress [1/pressure].
Mat6 compliance(const ElasticLaw& law);
std::vector<Mat6> compliances(const std::vector<Material>& materials);

/// Elastic strain of a stress.
Strain strain_of(const Stress& stress, const Mat6& compliance);

/// a : C^-1 : b; half of it with a = b is the strain energy density
/// [pressure].
double complementary_product(const Stress& a, const Stress& b,
                             const Mat6& compliance);

/// (stress : strain) / 2 [pressure].
double strain_energy_density(const Stress& stress, const Mat6& compliance);

}  // namespace meniscus
