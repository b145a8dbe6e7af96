/// Second-order forward duals: value, gradient and Hessian by the same
/// arithmetic as the value, exact to rounding.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace meniscus {

/// g's partial derivatives at two values.
struct Partials {
  double a, b, aa, ab, bb;
};

/// Arithmetic of numbers that carry derivatives: each operation is its value
/// and partial derivatives, handed to chain(), which Number must have for one
/// operand and for two.
template <class Number>
struct DualArithmetic {
  friend Number operator-(const Number& a) {
    return chain(a, -a.value, -1.0, 0.0);
  }
  friend Number operator+(const Number& a, const Number& b) {
    return chain(a, b, a.value + b.value, {1, 1, 0, 0, 0});
  }
  friend Number operator-(const Number& a, const Number& b) {
    return chain(a, b, a.value - b.value, {1, -1, 0, 0, 0});
  }
  friend Number operator*(const Number& a, const Number& b) {
    return chain(a, b, a.value * b.value, {b.value, a.value, 0, 1, 0});
  }
  friend Number operator/(const Number& a, const Number& b) {
    const double r = 1.0 / b.value;
    const double q = a.value / b.value;
    return chain(a, b, q, {r, -q * r, 0, -r * r, 2 * q * r * r});
  }

  friend Number sin(const Number& a) {
    const double s = std::sin(a.value);
    return chain(a, s, std::cos(a.value), -s);
  }
  friend Number cos(const Number& a) {
    const double c = std::cos(a.value);
    return chain(a, c, -std::sin(a.value), -c);
  }
  friend Number tan(const Number& a) {
    const double t = std::tan(a.value);
    return chain(a, t, 1 + t * t, 2 * t * (1 + t * t));
  }
  friend Number asin(const Number& a) {
    const double w = 1 - a.value * a.value;
    return chain(a, std::asin(a.value), 1 / std::sqrt(w),
                 a.value / (w * std::sqrt(w)));
  }
  friend Number acos(const Number& a) {
    const double w = 1 - a.value * a.value;
    return chain(a, std::acos(a.value), -1 / std::sqrt(w),
                 -a.value / (w * std::sqrt(w)));
  }
  friend Number atan(const Number& a) {
    const double w = 1 + a.value * a.value;
    return chain(a, std::atan(a.value), 1 / w, -2 * a.value / (w * w));
  }
  friend Number atan2(const Number& y, const Number& x) {
    const double w = y.value * y.value + x.value * x.value;
    const double xy = 2 * x.value * y.value / (w * w);
    const double dd = (y.value * y.value - x.value * x.value) / (w * w);
    return chain(y, x, std::atan2(y.value, x.value),
                 {x.value / w, -y.value / w, -xy, dd, xy});
  }
  friend Number sinh(const Number& a) {
    const double s = std::sinh(a.value);
    return chain(a, s, std::cosh(a.value), s);
  }
  friend Number cosh(const Number& a) {
    const double c = std::cosh(a.value);
    return chain(a, c, std::sinh(a.value), c);
  }
  friend Number tanh(const Number& a) {
    const double t = std::tanh(a.value);
    return chain(a, t, 1 - t * t, -2 * t * (1 - t * t));
  }
  friend Number exp(const Number& a) {
    const double e = std::exp(a.value);
    return chain(a, e, e, e);
  }
  friend Number log(const Number& a) {
    return chain(a, std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
  }
  friend Number sqrt(const Number& a) {
    const double s = std::sqrt(a.value);
    return chain(a, s, 0.5 / s, -0.25 / (s * a.value));
  }
  /// Not smooth at 0.
  friend Number abs(const Number& a) {
    return chain(a, std::abs(a.value), a.value < 0 ? -1.0 : 1.0, 0.0);
  }
  friend Number pow(const Number& a, const Number& b) {
    const double p = std::pow(a.value, b.value);
    if (b.is_constant()) {
      const double n = b.value;
      const double first = n == 0 ? 0.0 : n * std::pow(a.value, n - 1);
      const double second =
          n == 0 || n == 1 ? 0.0 : n * (n - 1) * std::pow(a.value, n - 2);
      return chain(a, p, first, second);
    }
    const double n = b.value;
    if (a.value == 0.0 && n > 1.0) {  // a^n log a is 0 there
      return chain(a, b, p,
                   {0.0, 0.0, n * (n - 1) * std::pow(a.value, n - 2), 0, 0});
    }
    const double l = std::log(a.value);
    return chain(a, b, p,
                 {n * std::pow(a.value, n - 1), p * l,
                  n * (n - 1) * std::pow(a.value, n - 2),
                  std::pow(a.value, n - 1) * (1 + n * l), p * l * l});
  }
};

template <int N>
struct BasicDual;

/// g(a) from g, g' and g'' at a's value.
template <int N>
BasicDual<N> chain(const BasicDual<N>& a, double g, double g1, double g2);

/// g(a, b) from g and its partial derivatives.
template <int N>
BasicDual<N> chain(const BasicDual<N>& a, const BasicDual<N>& b, double g,
                   const Partials& d);

/// f, df/dx_i and d2f/dx_i dx_j over N independent variables, or over a number
/// known only at run time (Eigen::Dynamic). Constants have no derivatives: for
/// Dynamic empty, else zero.
template <int N>
struct BasicDual : DualArithmetic<BasicDual<N>> {
  double value = 0.0;
  bool varies = false;  // not a constant
  Eigen::Matrix<double, N, 1> gradient;
  Eigen::Matrix<double, N, N> hessian;

  BasicDual() : BasicDual(0.0) {}
  BasicDual(double constant) : value(constant) {  // NOLINT: numbers are duals
    if constexpr (N != Eigen::Dynamic) {
      gradient.setZero();
      hessian.setZero();
    }
  }

  /// Variable `index` of `count`, which is N unless Dynamic.
  static BasicDual variable(double at, int index, int count = N) {
    BasicDual x(at);
    x.varies = true;
    x.gradient = Eigen::Matrix<double, N, 1>::Unit(count, index);
    x.hessian = Eigen::Matrix<double, N, N>::Zero(count, count);
    return x;
  }

  bool is_constant() const { return !varies; }
};

using Dual = BasicDual<Eigen::Dynamic>;
using Dual1 = BasicDual<1>;  // along one direction
using Dual3 = BasicDual<3>;  // over the coordinates of a place

template <int N>
BasicDual<N> chain(const BasicDual<N>& a, double g, double g1, double g2) {
  BasicDual<N> result(g);
  if (!a.is_constant()) {
    result.varies = true;
    result.gradient = g1 * a.gradient;
    result.hessian = g1 * a.hessian + g2 * a.gradient * a.gradient.transpose();
  }
  return result;
}

template <int N>
BasicDual<N> chain(const BasicDual<N>& a, const BasicDual<N>& b, double g,
                   const Partials& d) {
  if (b.is_constant()) {
    return chain(a, g, d.a, d.aa);
  }
  if (a.is_constant()) {
    return chain(b, g, d.b, d.bb);
  }
  BasicDual<N> result(g);
  result.varies = true;
  const Eigen::Matrix<double, N, N> cross = a.gradient * b.gradient.transpose();
  result.gradient = d.a * a.gradient + d.b * b.gradient;
  result.hessian = d.a * a.hessian + d.b * b.hessian +
                   d.aa * a.gradient * a.gradient.transpose() +
                   d.bb * b.gradient * b.gradient.transpose() +
                   d.ab * (cross + cross.transpose());
  return result;
}

}  // namespace meniscus
