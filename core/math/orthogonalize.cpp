#include "core/math/orthogonalize.h"

#include <algorithm>
#include <vector>

#include "core/parallel_for.h"

namespace meniscus {

namespace {

constexpr Eigen::Index kRows = 8192;  // of a part

/// part(first, rows, k) for the k-th kRows of n rows.
template <class Part>
void for_parts(Eigen::Index n, const Part& part) {
  parallel_for((n + kRows - 1) / kRows, [&](std::ptrdiff_t k) {
    const Eigen::Index first = k * kRows;
    part(first, std::min(kRows, n - first), k);
  });
}

/// Parts of Q^T v, summed in their order.
class PartSums {
 public:
  PartSums(Eigen::Index n, Eigen::Index count)
      : parts_(count, (n + kRows - 1) / kRows) {}

  auto part(Eigen::Index k) { return parts_.col(k); }

  VectorX total() const {
    VectorX sum = VectorX::Zero(parts_.rows());
    for (Eigen::Index k = 0; k < parts_.cols(); ++k) {
      sum += parts_.col(k);
    }
    return sum;
  }

 private:
  Eigen::MatrixXd parts_;
};

}  // namespace

VectorX coefficients_of(const Eigen::MatrixXd& Q, Eigen::Index count,
                        const VectorX& v) {
  PartSums sums(v.size(), count);
  for_parts(v.size(), [&](Eigen::Index first, Eigen::Index rows, auto k) {
    sums.part(k).noalias() =
        Q.block(first, 0, rows, count).transpose() * v.segment(first, rows);
  });
  return sums.total();
}

void orthogonalize(const Eigen::MatrixXd& Q, Eigen::Index count,
                   const VectorX& coefficients, VectorX& v) {
  // The rows that the first pass has just changed are still at hand for the
  // products of the second.
  PartSums sums(v.size(), count);
  for_parts(v.size(), [&](Eigen::Index first, Eigen::Index rows, auto k) {
    const auto q = Q.block(first, 0, rows, count);
    v.segment(first, rows).noalias() -= q * coefficients;
    sums.part(k).noalias() = q.transpose() * v.segment(first, rows);
  });
  const VectorX left = sums.total();
  for_parts(v.size(), [&](Eigen::Index first, Eigen::Index rows, auto /*k*/) {
    v.segment(first, rows).noalias() -= Q.block(first, 0, rows, count) * left;
  });
}

}  // namespace meniscus
