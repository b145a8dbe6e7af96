/// Gram and Schmidt's orthogonalisation against a basis of few long columns:
/// bound by memory, so in threads by rows, with the same bits for any number.
#pragma once

#include <Eigen/Core>

#include "core/types.h"

namespace meniscus {

/// Q^T v for the first `count` columns of Q; all have as many rows as v.
VectorX coefficients_of(const Eigen::MatrixXd& Q, Eigen::Index count,
                        const VectorX& v);

/// v - Q Q^T v for the first `count` columns of Q, which are orthonormal, twice
/// over, which is enough (Giraud, Langou, Rozloznik, van den Eshof 2005).
/// `coefficients`: Q^T v, from coefficients_of().
void orthogonalize(const Eigen::MatrixXd& Q, Eigen::Index count,
                   const VectorX& coefficients, VectorX& v);

}  // namespace meniscus
