/// The largest of a few numbers, smooth and from above.
#pragma once

#include <span>
#include <vector>

namespace meniscus {

struct SmoothExtreme {
  double value = 0.0;
  std::vector<double> by_number;  // derivatives
};

/// Kreisselmeier and Steinhauser's (s / k) ln sum exp(k x / s) with s the root
/// mean square of the n numbers and k = ln n / excess: never below the largest,
/// above it by at most `excess` times s, and in proportion to its numbers
/// whatever their unit. Smooth but where all are 0; there its derivative is
/// told as 0. One number is its own maximum. `excess` > 0; x not empty.
SmoothExtreme smooth_maximum(std::span<const double> x, double excess);

/// The least, from below: -smooth_maximum(-x).
SmoothExtreme smooth_minimum(std::span<const double> x, double excess);

}  // namespace meniscus
