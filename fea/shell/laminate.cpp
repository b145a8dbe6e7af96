#include "fea/shell/laminate.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/gauss_rule.h"

namespace meniscus::shell {

namespace {

/// In the material's own axes.
PlyLaw own_law(const element::Material& m) {
  PlyLaw law;
  law.density = m.density;
  law.expansion << m.thermal_expansion[0], m.thermal_expansion[1], 0.0;
  double E1 = m.youngs_modulus;
  double E2 = E1;
  double nu12 = m.poisson_ratio;
  double nu13 = nu12;
  double nu23 = nu12;
  double G12 = 0.5 * E1 / (1.0 + nu12);
  double G13 = G12;
  double G23 = G12;
  if (m.orthotropic) {
    E1 = m.orthotropic->youngs_moduli[0];
    E2 = m.orthotropic->youngs_moduli[1];
    nu12 = m.orthotropic->poisson_ratios[0];
    nu13 = m.orthotropic->poisson_ratios[1];
    nu23 = m.orthotropic->poisson_ratios[2];
    G12 = m.orthotropic->shear_moduli[0];
    G13 = m.orthotropic->shear_moduli[1];
    G23 = m.orthotropic->shear_moduli[2];
  }
  const double whole = 1.0 / (1.0 - nu12 * nu12 * E2 / E1);
  law.plane << E1 * whole, nu12 * E2 * whole, 0.0,  //
      nu12 * E2 * whole, E2 * whole, 0.0,           //
      0.0, 0.0, G12;
  law.across << G13, 0.0, 0.0, G23;
  law.squeeze << -nu13 / E1, -nu23 / E2, 0.0;
  return law;
}

PlyLaw turned(const PlyLaw& law, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  // Strains (11, 22, 2 x 12) in the ply's axes from those in the section's.
  Mat3 T;
  T << c * c, s * s, c * s,  //
      s * s, c * c, -c * s,  //
      -2.0 * c * s, 2.0 * c * s, c * c - s * s;
  Eigen::Matrix2d R;
  R << c, s, -s, c;
  PlyLaw result = law;
  result.plane = T.transpose() * law.plane * T;
  result.across = R.transpose() * law.across * R;
  const auto strain = [&](const Vec3& own) -> Vec3 {
    return {c * c * own[0] + s * s * own[1], s * s * own[0] + c * c * own[1],
            2.0 * c * s * (own[0] - own[1])};
  };
  result.expansion = strain(law.expansion);
  result.squeeze = strain(law.squeeze);
  return result;
}

}  // namespace

LaminateLaw laminate_law(const Laminate& laminate) {
  if (laminate.plies.empty()) {
    throw InvalidInput("a laminate has no ply; give it one");
  }
  if (!(laminate.shear_correction > 0.0)) {
    throw InvalidInput(fmt::format(
        "a laminate's shear correction is {}, and must be above 0 (5/6)",
        laminate.shear_correction));
  }
  double whole = 0.0;
  for (const Ply& ply : laminate.plies) {
    element::check_material(ply.material);
    if (!(ply.share > 0.0)) {
      throw InvalidInput(
          fmt::format("ply of {} has the share {} of the thickness, and must "
                      "have one above 0",
                      ply.material.name, ply.share));
    }
    whole += ply.share;
  }
  LaminateLaw law;
  law.shear_correction = laminate.shear_correction;
  double from = -0.5;
  for (const Ply& ply : laminate.plies) {
    const double share = ply.share / whole;
    const int number = static_cast<int>(law.plies.size());
    law.plies.push_back(turned(own_law(ply.material), ply.angle));
    law.from.push_back(from);
    law.to.push_back(from + share);
    for (const GaussPoint& g : gauss_rule(2)) {
      law.points.push_back(
          {from + share * (1.0 - g.at), share * g.weight, number});
    }
    law.mean_shear += share * law.plies.back().plane(2, 2);
    from += share;
  }
  return law;
}

LaminateStiffness laminate_stiffness(const LaminateLaw& law, double thickness) {
  LaminateStiffness result{Mat3::Zero(), Mat3::Zero(), Mat3::Zero(),
                           Eigen::Matrix2d::Zero()};
  for (const LayerPoint& point : law.points) {
    const PlyLaw& ply = law.plies[point.ply];
    const double z = point.at * thickness;
    const double w = point.weight * thickness;
    result.A += w * ply.plane;
    result.B += w * z * ply.plane;
    result.D += w * z * z * ply.plane;
    result.S += w * law.shear_correction * ply.across;
  }
  return result;
}

}  // namespace meniscus::shell
