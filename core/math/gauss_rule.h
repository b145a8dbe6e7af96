/// Gauss and Legendre's points on [0, 1].
#pragma once

#include <vector>

namespace meniscus {

struct GaussPoint {
  double at = 0.0;
  double weight = 0.0;  // they sum to 1
};

/// `points` of them, 1 or more, from 1 down to 0: exact for polynomials of
/// degree 2 points - 1.
std::vector<GaussPoint> gauss_rule(int points);

}  // namespace meniscus
