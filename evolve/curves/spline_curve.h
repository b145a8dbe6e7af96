/// Internal to curves: the periodic cubic through points, over numbers or
/// duals.
#pragma once

#include <vector>

#include "evolve/curves/curve_shape.h"

namespace meniscus::curves::curve_shape {

/// On the span from knot k to the next, x from 0 to h_k:
///   P_k (h - x) / h + P_k+1 x / h + M_k ((h - x)^3 / h - h (h - x)) / 6
///   + M_k+1 (x^3 / h - h x) / 6,
/// with second derivatives M from continuous first ones (de Boor 1978).
template <class Scalar>
class SplineCurve {
 public:
  /// Three points or more, no two neighbours equal.
  explicit SplineCurve(std::vector<Vector<Scalar>> points);

  /// t from 0 to 1, wrapped: the share of the chords' length.
  Vector<Scalar> at(double t) const;
  /// First derivative by that length, at point k.
  Vector<Scalar> slope(int k) const;

 private:
  std::vector<Vector<Scalar>> points_;
  std::vector<Scalar> chords_;
  std::vector<Scalar> knots_;  // one more than points: the last is the length
  std::vector<Vector<Scalar>> bends_;  // second derivatives
};

}  // namespace meniscus::curves::curve_shape
