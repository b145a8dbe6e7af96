#include "fea/modes/eigenvalue_bound.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace meniscus::modes {

EigenvalueBound eigenvalue_bound(const std::vector<double>& values,
                                 double width) {
  if (values.empty() || !(values.front() > 0.0) || !(width > 0.0) ||
      !std::isfinite(width)) {
    throw InvalidInput(fmt::format(
        "bound of eigenvalues: {} values from {}, width {}; there must be one, "
        "above 0, and a width above 0",
        values.size(), values.empty() ? 0.0 : values.front(), width));
  }
  const auto n = static_cast<Eigen::Index>(values.size());
  const VectorX v = Eigen::Map<const VectorX>(values.data(), n);
  const auto left = [&](double s) -> Eigen::ArrayXd {
    return ((1.0 + width - s * v.array()) / width).max(0.0);
  };
  // Newton for s = 1 / F: the sum is convex and falls, and is no less than 1 at
  // the start, so that s ascends to the root.
  constexpr int kMostSteps = 100;
  double s = 1.0 / v[0];
  for (int k = 0; k < kMostSteps; ++k) {
    const Eigen::ArrayXd t = left(s);
    const double slope = -3.0 / width * (t.square() * v.array()).sum();
    const double next = s - (t.cube().sum() - 1.0) / slope;
    if (!(next > s)) {
      break;
    }
    s = next;
  }
  const Eigen::ArrayXd weight = left(s).square();
  EigenvalueBound bound;
  bound.value = 1.0 / s;
  bound.reach = (1.0 + width) / s;
  bound.by_value = weight / (s * (weight * v.array()).sum());
  return bound;
}

}  // namespace meniscus::modes
