#include "io/nastran_material.h"

#include <Eigen/Geometry>

#include "core/math/dense.h"
#include "io/nastran_bdf.h"
#include "io/nastran_fields.h"

namespace meniscus::io {

namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Zero is left out: the field's default.
std::string unless_zero(double value) {
  return value != 0.0 ? nastran_real(value) : "";
}

/// Stress by strain (engineering shear) in the material's axes, in the order
/// 11 22 33 12 23 31.
Mat6 stiffness(const DeckOrthotropic& m) {
  const Vec3& E = m.youngs_moduli;
  const Vec3& nu = m.poisson_ratios;  // 12, 13, 23
  const Vec3& G = m.shear_moduli;     // 12, 13, 23
  Mat6 compliance = Mat6::Zero();
  for (int k = 0; k < 3; ++k) {
    compliance(k, k) = 1.0 / E[k];
  }
  compliance(0, 1) = compliance(1, 0) = -nu[0] / E[0];
  compliance(0, 2) = compliance(2, 0) = -nu[1] / E[0];
  compliance(1, 2) = compliance(2, 1) = -nu[2] / E[1];
  compliance(3, 3) = 1.0 / G[0];
  compliance(4, 4) = 1.0 / G[2];
  compliance(5, 5) = 1.0 / G[1];
  const Mat6 inverse = inverse_of(compliance);
  return 0.5 * (inverse + inverse.transpose());
}

std::string axes(const DeckOrthotropic& m, const std::string& id) {
  const Vec3 z = m.axis_1.cross(m.axis_2).normalized();
  const Vec3 x = m.axis_1.normalized();
  Fields fields = {id, "", "0.", "0.", "0."};
  for (const Vec3& point : {z, x}) {
    for (int k = 0; k < 3; ++k) {
      fields.push_back(nastran_real(point[k]));
    }
  }
  return long_card("CORD2R", fields);
}

std::string orthotropic(const DeckMaterial& material, const std::string& id) {
  const Mat6 C = stiffness(*material.orthotropic);
  Fields fields = {id};
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      fields.push_back(unless_zero(C(i, j)));
    }
  }
  fields.push_back(unless_zero(material.density));
  for (int k = 0; k < 3; ++k) {
    fields.push_back(unless_zero(material.thermal_expansion[k]));
  }
  return axes(*material.orthotropic, id) + long_card("MAT9", fields);
}

/// An isotropic material that expands by direction takes MAT9 too.
DeckMaterial by_direction(DeckMaterial material) {
  const double E = material.youngs_modulus;
  const double nu = material.poisson_ratio;
  material.orthotropic =
      DeckOrthotropic{.youngs_moduli = Vec3::Constant(E),
                      .poisson_ratios = Vec3::Constant(nu),
                      .shear_moduli = Vec3::Constant(0.5 * E / (1.0 + nu))};
  return material;
}

bool expands_evenly(const DeckMaterial& material) {
  const Vec3& a = material.thermal_expansion;
  return a == Vec3::Constant(a[0]);
}

}  // namespace

std::string nastran_material(const DeckMaterial& material, int id) {
  const std::string number = std::to_string(id);
  std::string text =
      "$ " + plain_text("material '" + material.name + "'") + "\n";
  if (material.orthotropic || !expands_evenly(material)) {
    return text + short_card("PSOLID", {number, number, number}) +
           orthotropic(material.orthotropic ? material : by_direction(material),
                       number);
  }
  return text + short_card("PSOLID", {number, number}) +
         isotropic_card(material, id);
}

std::string isotropic_card(const DeckMaterial& material, int id) {
  return long_card(
      "MAT1",
      {std::to_string(id), nastran_real(material.youngs_modulus), "",
       nastran_real(material.poisson_ratio), unless_zero(material.density),
       unless_zero(material.thermal_expansion[0])});
}

std::string ply_card(const DeckMaterial& material, int id) {
  if (!material.orthotropic) {
    return isotropic_card(material, id);
  }
  const DeckOrthotropic& m = *material.orthotropic;
  return long_card(
      "MAT8",
      {std::to_string(id), nastran_real(m.youngs_moduli[0]),
       nastran_real(m.youngs_moduli[1]), nastran_real(m.poisson_ratios[0]),
       nastran_real(m.shear_moduli[0]), nastran_real(m.shear_moduli[1]),
       nastran_real(m.shear_moduli[2]), unless_zero(material.density),
       unless_zero(material.thermal_expansion[0]),
       unless_zero(material.thermal_expansion[1])});
}

}  // namespace meniscus::io
