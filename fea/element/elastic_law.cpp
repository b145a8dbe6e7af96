#include "fea/element/elastic_law.h"

#include <Eigen/LU>

#include "core/math/dense.h"

namespace meniscus::element {

namespace {

/// Place of component ij among xx yy zz xy yz zx.
constexpr int kPlace[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/// Stiffness in the material's own axes, by inverting the compliance.
Mat6 own_stiffness(const Orthotropic& m) {
  const Vec3& E = m.youngs_moduli;
  const Vec3& nu = m.poisson_ratios;
  const Vec3& G = m.shear_moduli;
  Mat3 S;
  S << 1.0 / E[0], -nu[0] / E[0], -nu[1] / E[0],  //
      -nu[0] / E[0], 1.0 / E[1], -nu[2] / E[1],   //
      -nu[1] / E[0], -nu[2] / E[1], 1.0 / E[2];
  Mat6 D = Mat6::Zero();
  D.topLeftCorner<3, 3>() = S.inverse();
  D(3, 3) = G[0];
  D(4, 4) = G[2];
  D(5, 5) = G[1];
  return D;
}

Mat6 isotropic_stiffness(const Lame& m) {
  Mat6 D = Mat6::Zero();
  D.topLeftCorner<3, 3>().setConstant(m.lambda);
  D.diagonal().head<3>().array() += 2.0 * m.mu;
  D.diagonal().tail<3>().setConstant(m.mu);
  return D;
}

/// The map from stress components in axes R to those of the mesh.
Mat6 stress_rotation(const Mat3& R) {
  Mat6 T;
  for (int k = 0; k < 6; ++k) {
    T.col(k) =
        stress_components(R * stress_tensor(Vec6::Unit(k)) * R.transpose());
  }
  return T;
}

}  // namespace

Mat3 stress_tensor(const Vec6& s) {
  Mat3 t;
  t << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return t;
}

Vec6 stress_components(const Mat3& t) {
  Vec6 s;
  s << t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(1, 2), t(2, 0);
  return s;
}

ElasticLaw::ElasticLaw(const Lame& constants)
    : lame(constants),
      stiffness(isotropic_stiffness(constants)),
      compliance(inverse_of(stiffness)) {}

Mat3 ElasticLaw::stress(const Mat3& H) const {
  if (isotropic) {
    Mat3 s = lame.mu * (H + H.transpose());
    s.diagonal().array() += lame.lambda * H.trace();
    return s;
  }
  Vec6 strain;
  strain << H(0, 0), H(1, 1), H(2, 2), H(0, 1) + H(1, 0), H(1, 2) + H(2, 1),
      H(2, 0) + H(0, 2);
  return stress_tensor(stiffness * strain);
}

ElasticLaw elastic_law(const Material& material) {
  if (!material.orthotropic) {
    ElasticLaw law(lame(material));
    law.expansion.head<3>() = material.thermal_expansion;
    law.heat_stress = law.stiffness * law.expansion;
    return law;
  }
  ElasticLaw law;
  law.isotropic = false;
  const Mat3 R = unit_axes(material.orthotropic->axes);
  // Energy is the same in both axes: strains turn with the inverse transpose.
  const Mat6 T = stress_rotation(R);
  law.stiffness = T * own_stiffness(*material.orthotropic) * T.transpose();
  law.expansion = stress_components(
      R * material.thermal_expansion.asDiagonal() * R.transpose());
  law.expansion.tail<3>() *= 2.0;
  law.compliance = inverse_of(law.stiffness);
  law.heat_stress = law.stiffness * law.expansion;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
          law.tensor(3 * i + k, 3 * j + l) =
              law.stiffness(kPlace[i][j], kPlace[k][l]);
        }
      }
    }
  }
  return law;
}

Stress stress_of_gradient(const Mat3& gradient, const ElasticLaw& law) {
  if (law.isotropic) {
    return stress_of_gradient(gradient, law.lame);
  }
  const Mat3 s = law.stress(gradient);
  return {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0)};
}

Strain strain_of(const Stress& stress, const ElasticLaw& law) {
  if (law.isotropic) {
    return strain_of(stress, law.lame);
  }
  const Vec6 e = law.compliance * Eigen::Map<const Vec6>(stress.data());
  return {e[0], e[1], e[2], 0.5 * e[3], 0.5 * e[4], 0.5 * e[5]};
}

double complementary_product(const Stress& a, const Stress& b,
                             const ElasticLaw& law) {
  if (law.isotropic) {
    return complementary_product(a, b, law.lame);
  }
  return Eigen::Map<const Vec6>(a.data()).dot(law.compliance *
                                              Eigen::Map<const Vec6>(b.data()));
}

std::vector<ElasticLaw> elastic_laws(const std::vector<Material>& materials) {
  std::vector<ElasticLaw> laws;
  laws.reserve(materials.size());
  for (const Material& material : materials) {
    laws.push_back(elastic_law(material));
  }
  return laws;
}

}  // namespace meniscus::element
