/// Stress from strain: what the element kernels know of a material.
#pragma once

#include <vector>

#include "fea/element/material.h"
#include "fea/element/stress_measures.h"

namespace meniscus::element {

/// Components xx yy zz xy yz zx; shear strains are doubled (gamma).
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Stress = stiffness (strain - expansion * temperature change), in the axes
/// of the mesh.
struct ElasticLaw {
  ElasticLaw() = default;
  ElasticLaw(const Lame& constants);  // NOLINT: a Lame is a law

  bool isotropic = true;
  Lame lame;                       // of isotropic ones [pressure]
  Mat6 stiffness = Mat6::Zero();   // [pressure]
  Mat6 compliance = Mat6::Zero();  // its inverse [1/pressure]
  Vec6 expansion = Vec6::Zero();   // [1/temperature]
  /// Stress that holds a degree of expansion back [pressure/temperature].
  Vec6 heat_stress = Vec6::Zero();
  /// Of others: row 3 i + k, column 3 j + l is C_ijkl, so that a block of the
  /// stiffness matrix is K_ik = C_ijkl sum of V g_j g_l [pressure].
  Eigen::Matrix<double, 9, 9, Eigen::RowMajor> tensor;

  /// Symmetric; H: displacement gradient du_i/dx_j [pressure].
  Mat3 stress(const Mat3& H) const;
};

/// Materials must have passed check_materials().
ElasticLaw elastic_law(const Material& material);
std::vector<ElasticLaw> elastic_laws(const std::vector<Material>& materials);

/// As for isotropic materials, see stress_measures.h.
Stress stress_of_gradient(const Mat3& gradient, const ElasticLaw& law);
Strain strain_of(const Stress& stress, const ElasticLaw& law);
double complementary_product(const Stress& a, const Stress& b,
                             const ElasticLaw& law);

/// The symmetric tensor of six stress components, and back.
Mat3 stress_tensor(const Vec6& stress);
Vec6 stress_components(const Mat3& stress);

}  // namespace meniscus::element
