#include <cmath>

#include <Eigen/Dense>

#include "tests/support/exact_elasticity.h"

namespace meniscus::exact {

namespace {

Dual dot(const DualVec& a, const DualVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

DualVec scaled(const DualVec& a, const Dual& s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}

DualVec sum(const DualVec& a, const DualVec& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// Displacement around a cavity for a far pull S along z and constants of the
/// point source, Kelvin's doublet and the quadrupole.
DualVec around_cavity(const element::Material& m, double pull,
                      const Vec3& constants, const DualVec& x) {
  const double nu = m.poisson_ratio;
  const Dual r2 = dot(x, x);
  const Dual r = sqrt(r2);
  const DualVec q = {x[0] * (-1.0 / 3.0), x[1] * (-1.0 / 3.0),
                     x[2] * (2.0 / 3.0)};  // far stress deviator times x
  const Dual xqx = dot(x, q);
  const Dual r3 = r2 * r;
  const Dual r5 = r3 * r2;
  DualVec u =
      scaled({x[0] * -nu, x[1] * -nu, x[2]}, Dual(pull / m.youngs_modulus));
  u = sum(u, scaled(x, constants[0] / r3));
  u = sum(u, scaled(q, constants[1] * (4.0 * nu - 2.0) / r3));
  u = sum(u, scaled(x, constants[1] * -3.0 * xqx / r5));
  u = sum(u, scaled(q, constants[2] * 2.0 / r5));
  return sum(u, scaled(x, constants[2] * -5.0 * xqx / (r5 * r2)));
}

}  // namespace

Field thick_cylinder(const element::Material& m, double a, double b,
                     double pressure) {
  const double nu = m.poisson_ratio;
  const double c =
      (1.0 + nu) * pressure * a * a / (m.youngs_modulus * (b * b - a * a));
  return {m, [=](const DualVec& x) -> DualVec {
            const Dual r2 = x[0] * x[0] + x[1] * x[1];
            const Dual g = c * ((1.0 - 2.0 * nu) + b * b / r2);
            return {x[0] * g, x[1] * g, Dual(0.0)};
          }};
}

Field thick_sphere(const element::Material& m, double a, double b,
                   double pressure) {
  const double nu = m.poisson_ratio;
  const double c =
      pressure * a * a * a / (m.youngs_modulus * (b * b * b - a * a * a));
  return {m, [=](const DualVec& x) {
            const Dual r2 = dot(x, x);
            return scaled(x, c * ((1.0 - 2.0 * nu) + 0.5 * (1.0 + nu) * b * b *
                                                         b / (r2 * sqrt(r2))));
          }};
}

Field hole_in_plate(const element::Material& m, double a, double pull) {
  const double kappa = 3.0 - 4.0 * m.poisson_ratio;
  const double mu = element::lame(m).mu;
  // Szabo and Babuska, Finite Element Analysis (1991), in Cartesian terms:
  // cos 3t and sin 3t from cos t = x / r, sin t = y / r.
  return {m, [=](const DualVec& x) -> DualVec {
            const Dual r2 = x[0] * x[0] + x[1] * x[1];
            const Dual r = sqrt(r2);
            const Dual c = x[0] / r;
            const Dual s = x[1] / r;
            const Dual c3 = 4.0 * c * c * c - 3.0 * c;
            const Dual s3 = 3.0 * s - 4.0 * s * s * s;
            const Dual q = a / r;
            const double k = pull * a / (8.0 * mu);
            return {
                k * (c * (kappa + 1.0) / q +
                     2.0 * q * ((1.0 + kappa) * c + c3) - 2.0 * q * q * q * c3),
                k * (s * (kappa - 3.0) / q +
                     2.0 * q * ((1.0 - kappa) * s + s3) - 2.0 * q * q * q * s3),
                Dual(0.0)};
          }};
}

Field bent_ring(const element::Material& m, double a, double b, double moment) {
  // Timoshenko and Goodier, Theory of elasticity (3rd edition), section 29; in
  // plane strain with E / (1 - nu^2) and nu / (1 - nu).
  const double nu = m.poisson_ratio / (1.0 - m.poisson_ratio);
  const double e = m.youngs_modulus / (1.0 - m.poisson_ratio * m.poisson_ratio);
  const double w = b * b - a * a;
  const double l = std::log(b / a);
  const double n = w * w - 4.0 * a * a * b * b * l * l;
  const double A = -4.0 * moment / n * a * a * b * b * l;
  const double B = -2.0 * moment / n * w;
  const double C =
      moment / n * (w + 2.0 * (b * b * std::log(b) - a * a * std::log(a)));
  return {m, [=](const DualVec& x) -> DualVec {
            const Dual r2 = x[0] * x[0] + x[1] * x[1];
            const Dual r = sqrt(r2);
            // u_r / r and u_theta / r
            const Dual out =
                (-(1.0 + nu) * A / r2 + 2.0 * (1.0 - nu) * B * log(r) -
                 B * (1.0 + nu) + 2.0 * C * (1.0 - nu)) /
                e;
            const Dual around = 4.0 * B * atan2(x[1], x[0]) / e;
            return {out * x[0] - around * x[1], out * x[1] + around * x[0],
                    Dual(0.0)};
          }};
}

Field spherical_cavity(const element::Material& m, double pull) {
  const auto field = [m](double far, const Vec3& constants) {
    return Field(m, [m, far, constants](const DualVec& x) {
      return around_cavity(m, far, constants, x);
    });
  };
  // Traction at three points of the cavity is linear in the constants.
  Eigen::Matrix<double, 9, 3> A;
  Eigen::Matrix<double, 9, 1> b;
  const std::array<Vec3, 3> places = {Vec3(0.0, 0.0, 1.0), Vec3(1.0, 0.0, 0.0),
                                      Vec3(0.6, 0.0, 0.8)};
  for (int p = 0; p < 3; ++p) {
    const auto traction = [&](const Field& f) -> Vec3 {
      const element::Stress s = f.at(places[p]).stress;
      return element::stress_tensor(Eigen::Map<const element::Vec6>(s.data())) *
             places[p];
    };
    b.segment<3>(3L * p) = -traction(field(pull, Vec3::Zero()));
    for (int k = 0; k < 3; ++k) {
      A.col(k).segment<3>(3L * p) = traction(field(0.0, Vec3::Unit(k)));
    }
  }
  const Vec3 constants = A.colPivHouseholderQr().solve(b);
  return field(pull, constants);
}

}  // namespace meniscus::exact
