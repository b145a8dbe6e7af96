/// How far responses spread when the design scatters (tolerances).
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::samples {

struct LinearSpread {
  VectorX deviation;       // standard deviation per response
  Eigen::MatrixXd shares;  // variance's part by variable, rows sum to 1
};

/// First order: variance_i = sum_j (J_ij d_j)^2 for independent variables of
/// standard deviation d_j >= 0; J = d response_i / d x_j. A response that no
/// variable moves has deviation 0 and shares 0.
LinearSpread linear_spread(const Eigen::MatrixXd& jacobian,
                           const VectorX& deviations);

/// `unit` samples of (0, 1) as normally distributed designs about `mean`;
/// samples of 0 and 1 are moved inside by 2^-33.
std::vector<VectorX> normal_designs(const VectorX& mean,
                                    const VectorX& deviations,
                                    const std::vector<VectorX>& unit);

struct SampledSpread {
  int count = 0;
  VectorX mean;
  VectorX deviation;  // sample standard deviation (count - 1)
  /// Standard errors of both, from the sample's own second and fourth moments.
  VectorX mean_error;
  VectorX deviation_error;
  VectorX least;
  VectorX largest;
};

/// Of at least two answers of equal size; throws InvalidInput otherwise.
SampledSpread sampled_spread(const std::vector<VectorX>& values);

}  // namespace meniscus::samples
