/// Derivatives by the constants of materials.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/loads/load_case.h"

namespace meniscus::loads {

/// Of lambda . (f - K u) at fixed mesh, u and lambda. An ElasticModel keeps its
/// base's materials: these are for designs that change those.
struct MaterialGradient {
  std::vector<double> youngs_modulus;     // per region; orthotropic: all six
                                          // moduli in proportion, [per 1]
  std::vector<double> poisson_ratio;      // per region; orthotropic: 0
  std::vector<double> density;            // per region: of gravity and spin
  std::vector<double> thermal_expansion;  // per region, of all three alike
};

/// u, lambda: 3 per node. Throws InvalidInput: check_materials(), a
/// temperature that is not finite, sizes that do not fit.
MaterialGradient material_gradient(
    const TetMesh& mesh, const std::vector<element::Material>& materials,
    const LoadCase& load_case, const VectorX& u, const VectorX& lambda);

}  // namespace meniscus::loads
