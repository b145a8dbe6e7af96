// Several of the lowest modes of a constrained Hessian.
#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/math/dense.h"
#include "core/math/orthogonalize.h"
#include "evolve/energy/constrained_hessian.h"

namespace meniscus::energy {

namespace {

constexpr int kMostBlocks = 40;
constexpr int kMoreColumns = 2;      // than modes wanted, in a block
constexpr int kRestarts = 3;         // from the best vectors of a full space
constexpr double kResidual = 1e-10;  // of an eigenvalue of the inverse
// The same x the largest of them: next to collapse the first one dwarfs the
// others, which solves then know to no more digits.
constexpr double kRounding = 1e-14;
constexpr double kDependent = 1e-10;  // a column's part that is new

/// Fixed columns with parts in every mode, whatever the film's symmetry.
Eigen::MatrixXd start_block(Eigen::Index n, Eigen::Index columns) {
  Eigen::MatrixXd block(n, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double phase = 0.6180339887498949 * static_cast<double>(i + 1) *
                           std::sqrt(static_cast<double>(2 * j + 1));
      block(i, j) = phase - std::floor(phase) - 0.5;
    }
  }
  return block;
}

/// Adds the block's columns to an orthonormal basis of `built` columns, less
/// those that depend on it; returns how many it has then.
Eigen::Index extend_basis(const Eigen::MatrixXd& block, Eigen::Index built,
                          Eigen::MatrixXd& basis) {
  for (Eigen::Index j = 0; j < block.cols() && built < basis.cols(); ++j) {
    VectorX v = block.col(j);
    const double before = v.norm();
    orthogonalize(basis, built, coefficients_of(basis, built, v), v);
    const double length = v.norm();
    if (length > kDependent * before) {
      basis.col(built++) = v / length;
    }
  }
  return built;
}

}  // namespace

LowestModes ConstrainedHessian::lowest_modes(const VectorX& metric,
                                             int count) const {
  const Eigen::Index n = metric.size();
  const Eigen::Index room = std::max<Eigen::Index>(0, n - constraints_.cols());
  const auto wanted = std::min<Eigen::Index>(count, room);
  // The inverse on the constraint space in the metric's coordinates, M^1/2
  // (A^-1 - A^-1 B S^-1 B' A^-1) M^1/2 with S = B' A^-1 B here: symmetric, and
  // its largest eigenvalues are the inverses of the lowest.
  const VectorX root = metric.cwiseMax(1e-300).cwiseSqrt();
  const auto apply = [&](const Eigen::MatrixXd& v) -> Eigen::MatrixXd {
    Eigen::MatrixXd result = factor_.solve(root.asDiagonal() * v);
    if (constraints_.cols() > 0) {
      result -= inverse_constraints_ *
                (schur_inverse_ * (constraints_.transpose() * result));
    }
    return root.asDiagonal() * result;
  };
  const Eigen::Index width =
      std::min<Eigen::Index>(wanted + kMoreColumns, room);
  const Eigen::Index most = std::min<Eigen::Index>(width * kMostBlocks, room);
  LowestModes result;
  if (wanted == 0) {
    return result;
  }
  // Block Lanczos with full orthogonalisation: the Krylov space of a fixed
  // start block, one block wider at a time.
  Eigen::MatrixXd basis(n, most);
  Eigen::MatrixXd image(n, most);
  Eigen::MatrixXd small(most, most);  // upper triangle
  Eigen::MatrixXd block = apply(start_block(n, width));
  Eigen::Index built = 0;
  for (int restarts = 0;;) {
    const Eigen::Index before = built;
    built = extend_basis(block, built, basis);
    const Eigen::Index added = built - before;
    image.middleCols(before, added) = apply(basis.middleCols(before, added));
    block = image.middleCols(before, added);
    small.topRows(built).middleCols(before, added) =
        basis.leftCols(built).transpose() * block;
    // Rayleigh-Ritz on the space so far, and the residual of each pair.
    const Eigen::MatrixXd upper = small.topLeftCorner(built, built);
    const Eigen::MatrixXd full = upper.selfadjointView<Eigen::Upper>();
    const auto ritz = symmetric_eigen(full);
    const Eigen::Index found = std::min(wanted, built);
    const Eigen::MatrixXd y = ritz.vectors.rightCols(found).rowwise().reverse();
    const VectorX theta = ritz.values.tail(found).reverse();
    const Eigen::MatrixXd modes = basis.leftCols(built) * y;
    const Eigen::MatrixXd left =
        image.leftCols(built) * y - modes * theta.asDiagonal();
    const bool done =
        found == wanted &&
        (left.colwise().norm().transpose().array() <=
         (kResidual * theta.array()).max(kRounding * std::abs(theta[0])))
            .all();
    if (!done && built == most && built < room && restarts < kRestarts) {
      block = basis.leftCols(built) * ritz.vectors.rightCols(width);
      built = 0;
      ++restarts;
      continue;
    }
    if (done || added == 0 || built == most) {
      if (!done && built < room) {
        throw ModesNotFound(fmt::format(
            "the {} lowest eigenvalues of a film were not found in {} steps",
            wanted, (restarts + 1) * most));
      }
      // Back from the inverse and from the metric's coordinates.
      result.eigenvalues = theta.cwiseInverse();
      result.modes = root.cwiseInverse().asDiagonal() * modes;
      return result;
    }
  }
}

}  // namespace meniscus::energy
