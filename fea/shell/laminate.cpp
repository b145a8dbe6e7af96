#include "fea/shell/laminate.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dual.h"
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

/// Of the law in the material's own axes.
PlyLaw by_modulus(const element::Material& m, const PlyLaw& own) {
  const double share = m.orthotropic ? 1.0 : 1.0 / m.youngs_modulus;
  return {.plane = share * own.plane,
          .across = share * own.across,
          .squeeze = -share * own.squeeze};
}

/// From the section's axes to a ply's.
struct PlyTurn {
  explicit PlyTurn(double angle) : c(std::cos(angle)), s(std::sin(angle)) {
    strain << c * c, s * s, c * s,  //
        s * s, c * c, -c * s,       //
        -2.0 * c * s, 2.0 * c * s, c * c - s * s;
    across << c, s, -s, c;
  }

  double c, s;
  Mat3 strain;             // (11, 22, 2 x 12)
  Eigen::Matrix2d across;  // (13, 23)
};

PlyLaw by_angle(const PlyLaw& own, double angle) {
  const PlyTurn turn(angle);
  const auto& [c, s, T, R] = turn;
  const double c2 = c * c - s * s;
  const double s2 = 2.0 * c * s;
  Mat3 dT;
  dT << -s2, s2, c2,  //
      s2, -s2, -c2,   //
      -2.0 * c2, 2.0 * c2, -2.0 * s2;
  Eigen::Matrix2d dR;
  dR << -s, c, -c, -s;
  const Mat3 half = T.transpose() * own.plane * dT;
  const Eigen::Matrix2d shear = R.transpose() * own.across * dR;
  const auto strain = [&](const Vec3& e) -> Vec3 {
    return (e[0] - e[1]) * Vec3(-s2, s2, 2.0 * c2);
  };
  return {.plane = half + half.transpose(),
          .across = shear + shear.transpose(),
          .expansion = strain(own.expansion),
          .squeeze = strain(own.squeeze)};
}

PlyLaw turned(const PlyLaw& law, double angle) {
  const PlyTurn turn(angle);
  PlyLaw result = law;
  result.plane = turn.strain.transpose() * law.plane * turn.strain;
  result.across = turn.across.transpose() * law.across * turn.across;
  const auto strain = [c = turn.c, s = turn.s](const Vec3& own) -> Vec3 {
    return {c * c * own[0] + s * s * own[1], s * s * own[0] + c * c * own[1],
            2.0 * c * s * (own[0] - own[1])};
  };
  result.expansion = strain(law.expansion);
  result.squeeze = strain(law.squeeze);
  return result;
}

/// The mean of a ply's stiffness along all directions, shear in proportion: it
/// does not hang on the axes (Tsai and Hahn's U1).
double mean_stiffness(const PlyLaw& ply) {
  const Mat3& Q = ply.plane;
  return (3.0 * (Q(0, 0) + Q(1, 1)) + 2.0 * Q(0, 1) + 4.0 * Q(2, 2)) / 8.0;
}

/// Integrals over each ply of the square of a unit shear force's stress, of
/// plies of stiffness E in a wall of thickness 1.
template <class T>
std::vector<T> shear_squares(const LaminateLaw& law, const std::vector<T>& E) {
  T whole(0.0);
  T first(0.0);
  for (std::size_t p = 0; p < E.size(); ++p) {
    const double a = law.from[p];
    const double b = law.to[p];
    whole = whole + (b - a) * E[p];
    first = first + 0.5 * (b * b - a * a) * E[p];
  }
  const T neutral = first / whole;
  T bending(0.0);
  T below(0.0);  // integral of E (z - neutral) up to the ply
  std::vector<T> squares;
  for (std::size_t p = 0; p < E.size(); ++p) {
    const T a = law.from[p] - neutral;
    const T b = law.to[p] - neutral;
    bending = bending + E[p] * (b * b * b - a * a * a) / 3.0;
    // below + E / 2 (z^2 - a^2): a square of degree four, by three points.
    T sum(0.0);
    for (const GaussPoint& g : gauss_rule(3)) {
      const T z = a + g.at * (b - a);
      const T stress = below + 0.5 * E[p] * (z * z - a * a);
      sum = sum + g.weight * stress * stress;
    }
    squares.push_back((b - a) * sum);
    below = below + 0.5 * E[p] * (b * b - a * a);
  }
  for (T& square : squares) {
    square = square / (bending * bending);
  }
  return squares;
}

/// Sets `across` and its rates.
void add_shear(LaminateLaw& law) {
  const std::size_t plies = law.plies.size();
  std::vector<double> E;
  std::vector<Eigen::Matrix2d> soft;
  for (const PlyLaw& ply : law.plies) {
    E.push_back(mean_stiffness(ply));
    soft.push_back(ply.across.inverse());
  }
  const std::vector<double> squares = shear_squares(law, E);
  Eigen::Matrix2d compliance = Eigen::Matrix2d::Zero();
  for (std::size_t p = 0; p < plies; ++p) {
    compliance += squares[p] * soft[p];
  }
  law.across = compliance.inverse();
  for (std::size_t p = 0; p < plies; ++p) {
    std::vector<Dual1> moved(E.begin(), E.end());
    moved[p] = Dual1::variable(E[p], 0);
    const std::vector<Dual1> by_E = shear_squares(law, moved);
    Eigen::Matrix2d of_squares = Eigen::Matrix2d::Zero();
    for (std::size_t q = 0; q < plies; ++q) {
      of_squares += by_E[q].gradient[0] * soft[q];
    }
    for (LawRate* rate : {&law.rates[p].by_modulus, &law.rates[p].by_angle}) {
      const Eigen::Matrix2d by =
          mean_stiffness(rate->ply) * of_squares -
          squares[p] * soft[p] * rate->ply.across * soft[p];
      rate->across = -law.across * by * law.across;
    }
  }
}

}  // namespace

LaminateLaw laminate_law(const Laminate& laminate) {
  if (laminate.plies.empty()) {
    throw InvalidInput("a laminate has no ply; give it one");
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
  double from = -0.5;
  for (const Ply& ply : laminate.plies) {
    const double share = ply.share / whole;
    const int number = static_cast<int>(law.plies.size());
    const PlyLaw own = own_law(ply.material);
    law.plies.push_back(turned(own, ply.angle));
    law.rates.push_back({{turned(by_modulus(ply.material, own), ply.angle)},
                         {by_angle(own, ply.angle)}});
    law.from.push_back(from);
    law.to.push_back(from + share);
    for (const GaussPoint& g : gauss_rule(2)) {
      law.points.push_back(
          {from + share * (1.0 - g.at), share * g.weight, number});
    }
    law.mean_shear += share * law.plies.back().plane(2, 2);
    from += share;
  }
  add_shear(law);
  return law;
}

LawGradient::LawGradient(const LaminateLaw& of) : law(of) {
  by.resize(law.plies.size());
}

std::vector<PlyGradient> LawGradient::by_ply() const {
  std::vector<PlyGradient> result;
  for (std::size_t p = 0; p < by.size(); ++p) {
    const auto along = [&](const LawRate& rate) {
      return by[p].plane.cwiseProduct(rate.ply.plane).sum() +
             by[p].expansion.dot(rate.ply.expansion) +
             by[p].squeeze.dot(rate.ply.squeeze) +
             by_across.cwiseProduct(rate.across).sum() +
             by_mean_shear * (law.to[p] - law.from[p]) * rate.ply.plane(2, 2);
    };
    result.push_back({.modulus = along(law.rates[p].by_modulus),
                      .density = by[p].density,
                      .angle = along(law.rates[p].by_angle)});
  }
  return result;
}

void add_plies(double factor, const PlyGradients& more, PlyGradients& sum) {
  sum.resize(std::max(sum.size(), more.size()));
  for (std::size_t s = 0; s < more.size(); ++s) {
    sum[s].resize(std::max(sum[s].size(), more[s].size()));
    for (std::size_t p = 0; p < more[s].size(); ++p) {
      sum[s][p].modulus += factor * more[s][p].modulus;
      sum[s][p].density += factor * more[s][p].density;
      sum[s][p].angle += factor * more[s][p].angle;
    }
  }
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
  }
  result.S = thickness * law.across;
  return result;
}

}  // namespace meniscus::shell
