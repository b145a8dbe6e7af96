/// Macaulay's bracket <s>^n, rounded (docs/decisions/0008).
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

namespace meniscus {

/// <s>^n over the width w, of numbers or of duals:
///
///   ((s + sqrt(s^2 + w^2)) / 2)^n,   for n = 0   (1 + s / sqrt(s^2 + w^2)) / 2
///
/// which is the slope of n = 1. With w a constant 0 it is max(s, 0)^n with its
/// corner, for n = 0 a switch that is 1 at s = 0. NaN for n below 0.
template <class Scalar>
Scalar macaulay(const Scalar& s, const Scalar& n, const Scalar& w) {
  using std::pow, std::sqrt;
  const auto value = [](const Scalar& x) {
    if constexpr (std::is_same_v<Scalar, double>) {
      return x;
    } else {
      return x.value;
    }
  };
  const auto is_zero = [&](const Scalar& x) {
    if constexpr (std::is_same_v<Scalar, double>) {
      return x == 0.0;
    } else {
      return x.value == 0.0 && x.is_constant();
    }
  };
  if (value(n) < 0.0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const bool switches = value(n) == 0.0;
  const bool above = value(s) > 0.0;
  if (is_zero(w)) {
    return switches ? Scalar(value(s) < 0.0 ? 0.0 : 1.0)
           : above  ? Scalar(pow(s, n))
                    : Scalar(0.0);
  }
  const Scalar root = sqrt(s * s + w * w);
  // Below the corner the same number without the difference of near equals.
  const Scalar ramp =
      Scalar(0.5) * (above ? Scalar(s + root) : Scalar(w * w / (root - s)));
  return switches ? Scalar(ramp / root) : Scalar(pow(ramp, n));
}

}  // namespace meniscus
