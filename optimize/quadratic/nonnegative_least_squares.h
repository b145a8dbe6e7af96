/// Least squares over what is not below 0 (Lawson & Hanson, Solving Least
/// Squares Problems, 1974, algorithm NNLS).
#pragma once

#include "core/types.h"

namespace meniscus::quadratic {

/// x >= 0 that minimises |A x - b|. Same input, same bits.
VectorX nonnegative_least_squares(const Eigen::MatrixXd& A, const VectorX& b);

}  // namespace meniscus::quadratic
