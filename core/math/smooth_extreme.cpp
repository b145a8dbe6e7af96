#include "core/math/smooth_extreme.h"

#include <algorithm>
#include <cmath>

namespace meniscus {

SmoothExtreme smooth_maximum(std::span<const double> x, double excess) {
  if (x.size() == 1) {
    return {x.front(), {1.0}};
  }
  const auto count = static_cast<double>(x.size());
  double squares = 0.0;
  for (const double value : x) {
    squares += value * value;
  }
  const double scale = std::sqrt(squares / count);
  SmoothExtreme result{0.0, std::vector<double>(x.size(), 0.0)};
  if (scale == 0.0) {
    return result;
  }
  const double sharpness = std::log(count) / excess;
  const double largest = *std::max_element(x.begin(), x.end());
  double sum = 0.0;
  double mean = 0.0;  // of the numbers by their weights
  for (std::size_t i = 0; i < x.size(); ++i) {
    result.by_number[i] = std::exp(sharpness * (x[i] - largest) / scale);
    sum += result.by_number[i];
    mean += result.by_number[i] * x[i];
  }
  mean /= sum;
  result.value = largest + scale / sharpness * std::log(sum);
  // The scale moves with the numbers: d value / d scale = (value - mean) /
  // scale, d scale / d x = x / (n scale).
  const double by_square = (result.value - mean) / (scale * scale * count);
  for (std::size_t i = 0; i < x.size(); ++i) {
    result.by_number[i] = result.by_number[i] / sum + by_square * x[i];
  }
  return result;
}

SmoothExtreme smooth_minimum(std::span<const double> x, double excess) {
  std::vector<double> turned(x.begin(), x.end());
  for (double& value : turned) {
    value = -value;
  }
  SmoothExtreme result = smooth_maximum(turned, excess);
  result.value = -result.value;
  return result;
}

}  // namespace meniscus
