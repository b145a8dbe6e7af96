/// Linear-elastic materials, isotropic or orthotropic.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/local_axes.h"

namespace meniscus::element {

/// Three planes of symmetry. Poisson's ratio 12 is the contraction along axis
/// 2 under a pull along axis 1: nu12 / E1 = nu21 / E2 (as CalculiX and Abaqus
/// say ENGINEERING CONSTANTS).
struct Orthotropic {
  Vec3 youngs_moduli = Vec3::Zero();   // along axes 1, 2, 3 [pressure], > 0
  Vec3 poisson_ratios = Vec3::Zero();  // 12, 13, 23
  Vec3 shear_moduli = Vec3::Zero();    // 12, 13, 23 [pressure], > 0
  LocalAxes axes;                      // 1 and 2; 3 across them
};

struct Material {
  std::string name;
  double youngs_modulus = 0.0;           // [pressure], > 0
  double poisson_ratio = 0.0;            // -1 < nu < 0.5
  double density = 0.0;                  // [mass/length^3], >= 0
  std::optional<double> yield_strength;  // [pressure]
  /// Instead of youngs_modulus and poisson_ratio, which are then not read.
  std::optional<Orthotropic> orthotropic;
  /// Strain per degree along the material's axes; three equal numbers for an
  /// isotropic material [1/temperature].
  Vec3 thermal_expansion = Vec3::Zero();
  // What it endures of stress to and fro [pressure]:
  std::optional<double> endurance_limit;   // amplitude of reversed tension
  std::optional<double> tensile_strength;  // at break
  std::optional<double> torsion_limit;     // amplitude of reversed torsion
};

/// Lame's constants: stress = lambda tr(strain) I + 2 mu strain [pressure].
struct Lame {
  double lambda = 0.0;
  double mu = 0.0;
};
Lame lame(const Material& material);

/// Throws InvalidInput, naming the material, for a modulus, Poisson's ratio,
/// density or expansion out of its range, and for orthotropic constants that
/// make no positive definite stiffness.
void check_material(const Material& material);

/// The same for all, and for a region of `mesh` without a material.
void check_materials(const TetMesh& mesh,
                     const std::vector<Material>& materials);

}  // namespace meniscus::element
