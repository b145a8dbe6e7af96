/// Derivatives by the numbers of a load case and of materials.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/load_case.h"
#include "fea/material.h"

namespace meniscus {

/// d(lambda . f) by each number of a load case, once for any number of design
/// variables: a load case whose numbers are derivatives, and for fields the
/// places where they are asked and what each value counts.
struct LoadGradient {
  LoadCase by_number;
  struct NumberField {
    Points places;
    std::vector<double> weights;
  };
  struct VectorField {
    Points places;
    Points weights;
  };
  std::vector<NumberField> pressures;  // of each; empty without a field
  std::vector<VectorField> tractions;
  NumberField temperature;
};

/// Of the load case's own loads at fixed mesh; lambda: 3 per node. Throws as
/// nodal_forces().
LoadGradient load_gradient(const TetMesh& mesh,
                           const std::vector<Material>& materials,
                           const LoadCase& load_case, const VectorX& lambda);

/// lambda . df for `rates`: a load case with the same loads, every number (and
/// field) of which is its derivative by one design variable. Supports and
/// springs are not read. Throws InvalidInput when the loads differ in number
/// or a field's rate is not given.
double load_rate(const LoadGradient& gradient, const LoadCase& rates);

/// Derivatives of lambda . (f - K u) by the constants of each region's
/// isotropic material; of orthotropic ones by density alone. By density: f's
/// gravity and spin.
struct MaterialGradient {
  std::vector<double> youngs_modulus;     // per region
  std::vector<double> poisson_ratio;      // per region
  std::vector<double> density;            // per region
  std::vector<double> thermal_expansion;  // per region, of all three alike
};
MaterialGradient material_gradient(const TetMesh& mesh,
                                   const std::vector<Material>& materials,
                                   const LoadCase& load_case, const VectorX& u,
                                   const VectorX& lambda);

/// Its product with the rates of the materials' constants.
double material_rate(const MaterialGradient& gradient,
                     const std::vector<Material>& rates);

}  // namespace meniscus
