/// A surface's section across a curve where it ends. Values, or with duals of
/// first order their derivatives.
#pragma once

#include <array>

#include <Eigen/Core>

namespace meniscus::fillets {

/// A surface's section from the curve into it: the cubic through four points
/// at 0, 1/3, 2/3 and 1 of `length`.
template <class T>
struct Section {
  using Vector = Eigen::Matrix<T, 3, 1>;
  std::array<Vector, 4> nodes;
  double length = 0.0;
  double out = 1.0;  // the outward normal is out x along x inward
  double arc = 0.0;  // of length: what the arc took when it was frozen

  Vector at(const T& s) const;
  Vector slope(const T& s) const;  // by s
  Vector bend(const T& s) const;   // by s twice

 private:
  std::array<Vector, 4> powers() const;  // of s / length
};

template <class T>
std::array<typename Section<T>::Vector, 4> Section<T>::powers() const {
  const auto& [p, q, r, e] = nodes;
  return {p, Vector(p * T(-5.5) + q * T(9.0) + r * T(-4.5) + e),
          Vector(p * T(9.0) + q * T(-22.5) + r * T(18.0) + e * T(-4.5)),
          Vector(p * T(-4.5) + q * T(13.5) + r * T(-13.5) + e * T(4.5))};
}

template <class T>
typename Section<T>::Vector Section<T>::at(const T& s) const {
  const auto c = powers();
  const T x = s / T(length);
  return c[0] + (c[1] + (c[2] + c[3] * x) * x) * x;
}

template <class T>
typename Section<T>::Vector Section<T>::slope(const T& s) const {
  const auto c = powers();
  const T x = s / T(length);
  return (c[1] + (c[2] * T(2.0) + c[3] * T(T(3.0) * x)) * x) / T(length);
}

template <class T>
typename Section<T>::Vector Section<T>::bend(const T& s) const {
  const auto c = powers();
  return (c[2] * T(2.0) + c[3] * T(T(6.0) * s / T(length))) /
         T(length * length);
}

}  // namespace meniscus::fillets
