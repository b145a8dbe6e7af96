/// Isotropic linear-elastic materials.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/tet_mesh.h"

namespace meniscus {

struct Material {
  std::string name;
  double youngs_modulus = 0.0;           // [pressure], > 0
  double poisson_ratio = 0.0;            // -1 < nu < 0.5
  double density = 0.0;                  // [mass/length^3], >= 0
  std::optional<double> yield_strength;  // [pressure]
};

/// Lame's constants: stress = lambda tr(strain) I + 2 mu strain [pressure].
struct Lame {
  double lambda = 0.0;
  double mu = 0.0;
};
Lame lame(const Material& material);

/// Throws InvalidInput, naming the material, for a modulus, Poisson's ratio or
/// density out of its range, and for a region of `mesh` without a material.
void check_materials(const TetMesh& mesh,
                     const std::vector<Material>& materials);

}  // namespace meniscus
