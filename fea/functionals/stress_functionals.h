/// Stress at the integration points (point_stress.h) as functionals
/// (functional.h). Averages are over the volume of the elements that count, so
/// that they do not depend on the mesh's fineness; a region's temperature is
/// that of the load case. All throw InvalidInput: sizes that do not fit the
/// mesh, nothing left by the exclusion, a field without a slope.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/functional.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::functionals {

struct StressFunctionalInput {
  const TetMesh& mesh;
  const std::vector<element::Material>& materials;
  const loads::LoadCase& load_case;  // for its temperature
  const VectorX& displacement;
  /// One char per element, 1 where it is left out (exclusion_zones.h's
  /// excluded_by() at the base design); empty: all count.
  const std::vector<char>& excluded;
  element::Derivatives derivatives = element::Derivatives::All;
};

/// ((1/V) int s^p dV)^(1/p), s the von Mises stress [pressure]: between the
/// mean and the peak, to the peak as p grows. p >= 1.
element::Functional von_mises_norm_functional(
    const StressFunctionalInput& input, double power);

/// (scale / k) ln((1/V) int exp(k s / scale) dV), s the von Mises stress:
/// Kreisselmeier and Steinhauser's smooth maximum [pressure], by volume; from
/// below to the peak as k grows. `scale`: a stress, a yield strength, say.
struct KsOptions {
  double sharpness = 50.0;  // k > 0
  double scale = 1.0;       // > 0 [pressure]
};
element::Functional von_mises_ks_functional(const StressFunctionalInput& input,
                                            const KsOptions& options);

/// Standard deviation over volume / mean: Uniformity's
/// coefficient_of_variation (stress_uniformity.h) [1].
element::Functional von_mises_variation_functional(
    const StressFunctionalInput& input);
element::Functional energy_density_variation_functional(
    const StressFunctionalInput& input);

}  // namespace meniscus::functionals
