/// Second-order forward duals: value, gradient and Hessian by the same
/// arithmetic as the value, exact to rounding.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace meniscus {

/// f, df/dx_i and d2f/dx_i dx_j over k independent variables. An empty
/// gradient stands for a constant.
struct Dual {
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: numbers are duals

  /// Variable `index` of `count`.
  static Dual variable(double at, int index, int count) {
    Dual x(at);
    x.gradient = Eigen::VectorXd::Unit(count, index);
    x.hessian = Eigen::MatrixXd::Zero(count, count);
    return x;
  }

  bool is_constant() const { return gradient.size() == 0; }
};

/// g(a) from g, g' and g'' at a's value.
inline Dual chain(const Dual& a, double g, double g1, double g2) {
  Dual result(g);
  if (!a.is_constant()) {
    result.gradient = g1 * a.gradient;
    result.hessian = g1 * a.hessian + g2 * a.gradient * a.gradient.transpose();
  }
  return result;
}

/// g(a, b) from g's partial derivatives at the values.
struct Partials {
  double a, b, aa, ab, bb;
};
inline Dual chain(const Dual& a, const Dual& b, double g, const Partials& d) {
  if (b.is_constant()) {
    return chain(a, g, d.a, d.aa);
  }
  if (a.is_constant()) {
    return chain(b, g, d.b, d.bb);
  }
  Dual result(g);
  const Eigen::MatrixXd cross = a.gradient * b.gradient.transpose();
  result.gradient = d.a * a.gradient + d.b * b.gradient;
  result.hessian = d.a * a.hessian + d.b * b.hessian +
                   d.aa * a.gradient * a.gradient.transpose() +
                   d.bb * b.gradient * b.gradient.transpose() +
                   d.ab * (cross + cross.transpose());
  return result;
}

inline Dual operator-(const Dual& a) { return chain(a, -a.value, -1.0, 0.0); }
inline Dual operator+(const Dual& a, const Dual& b) {
  return chain(a, b, a.value + b.value, {1, 1, 0, 0, 0});
}
inline Dual operator-(const Dual& a, const Dual& b) {
  return chain(a, b, a.value - b.value, {1, -1, 0, 0, 0});
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return chain(a, b, a.value * b.value, {b.value, a.value, 0, 1, 0});
}
inline Dual operator/(const Dual& a, const Dual& b) {
  const double r = 1.0 / b.value;
  const double q = a.value / b.value;
  return chain(a, b, q, {r, -q * r, 0, -r * r, 2 * q * r * r});
}

inline Dual sin(const Dual& a) {
  const double s = std::sin(a.value);
  return chain(a, s, std::cos(a.value), -s);
}
inline Dual cos(const Dual& a) {
  const double c = std::cos(a.value);
  return chain(a, c, -std::sin(a.value), -c);
}
inline Dual tan(const Dual& a) {
  const double t = std::tan(a.value);
  return chain(a, t, 1 + t * t, 2 * t * (1 + t * t));
}
inline Dual asin(const Dual& a) {
  const double w = 1 - a.value * a.value;
  return chain(a, std::asin(a.value), 1 / std::sqrt(w),
               a.value / (w * std::sqrt(w)));
}
inline Dual acos(const Dual& a) {
  const double w = 1 - a.value * a.value;
  return chain(a, std::acos(a.value), -1 / std::sqrt(w),
               -a.value / (w * std::sqrt(w)));
}
inline Dual atan(const Dual& a) {
  const double w = 1 + a.value * a.value;
  return chain(a, std::atan(a.value), 1 / w, -2 * a.value / (w * w));
}
inline Dual atan2(const Dual& y, const Dual& x) {
  const double w = y.value * y.value + x.value * x.value;
  const double xy = 2 * x.value * y.value / (w * w);
  const double dd = (y.value * y.value - x.value * x.value) / (w * w);
  return chain(y, x, std::atan2(y.value, x.value),
               {x.value / w, -y.value / w, -xy, dd, xy});
}
inline Dual sinh(const Dual& a) {
  const double s = std::sinh(a.value);
  return chain(a, s, std::cosh(a.value), s);
}
inline Dual cosh(const Dual& a) {
  const double c = std::cosh(a.value);
  return chain(a, c, std::sinh(a.value), c);
}
inline Dual tanh(const Dual& a) {
  const double t = std::tanh(a.value);
  return chain(a, t, 1 - t * t, -2 * t * (1 - t * t));
}
inline Dual exp(const Dual& a) {
  const double e = std::exp(a.value);
  return chain(a, e, e, e);
}
inline Dual log(const Dual& a) {
  return chain(a, std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
}
inline Dual sqrt(const Dual& a) {
  const double s = std::sqrt(a.value);
  return chain(a, s, 0.5 / s, -0.25 / (s * a.value));
}
/// Not smooth at 0.
inline Dual abs(const Dual& a) {
  return chain(a, std::abs(a.value), a.value < 0 ? -1.0 : 1.0, 0.0);
}
inline Dual pow(const Dual& a, const Dual& b) {
  const double p = std::pow(a.value, b.value);
  if (b.is_constant()) {
    const double n = b.value;
    const double first = n == 0 ? 0.0 : n * std::pow(a.value, n - 1);
    const double second =
        n == 0 || n == 1 ? 0.0 : n * (n - 1) * std::pow(a.value, n - 2);
    return chain(a, p, first, second);
  }
  const double l = std::log(a.value);
  const double n = b.value;
  return chain(a, b, p,
               {n * std::pow(a.value, n - 1), p * l,
                n * (n - 1) * std::pow(a.value, n - 2),
                std::pow(a.value, n - 1) * (1 + n * l), p * l * l});
}

}  // namespace meniscus
