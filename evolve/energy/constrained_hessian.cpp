#include "evolve/energy/constrained_hessian.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "core/math/dense.h"
#include "core/math/orthogonalize.h"

namespace meniscus::energy {

namespace {

constexpr int kLanczosSteps = 60;
constexpr int kLanczosCheck = 5;           // steps between looks
constexpr double kLanczosAccuracy = 1e-6;  // of the eigenvalue, relative
constexpr double kPivotShift = 1e-12;  // x mean diagonal, after a zero pivot

/// A fixed vector with parts in every mode, whatever the film's symmetry.
VectorX start_vector(Eigen::Index n) {
  VectorX v(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double phase = 0.6180339887498949 * static_cast<double>(i + 1);
    v[i] = 0.25 + (phase - std::floor(phase));
  }
  return v;
}

struct RitzPair {
  double value = 0.0;
  VectorX vector;
};

/// The eigenvalue of a symmetric operator that is largest, or when `negative`
/// of them are below zero, the negative one nearest to zero: both the inverse
/// of a Hessian's lowest eigenvalue.
RitzPair pick(const Eigen::MatrixXd& upper, int negative) {
  const Eigen::MatrixXd full = upper.selfadjointView<Eigen::Upper>();
  const auto eigen = symmetric_eigen(full);
  const Eigen::Index last = upper.cols() - 1;
  const Eigen::Index at =
      negative > 0 ? std::min<Eigen::Index>(negative - 1, last) : last;
  return {eigen.values[at], eigen.vectors.col(at)};
}

/// Lanczos with full orthogonalisation from a fixed start vector.
template <typename Operator>
RitzPair lanczos(const Operator& apply, Eigen::Index n, int negative) {
  const auto steps = std::min<Eigen::Index>(kLanczosSteps, n);
  Eigen::MatrixXd basis(n, steps);
  Eigen::MatrixXd small = Eigen::MatrixXd::Zero(steps, steps);
  VectorX v = n > 0 ? apply(start_vector(n)) : VectorX();
  VectorX along;  // the basis' part of v
  RitzPair found;
  double scale = 0.0;
  Eigen::Index built = 0;
  while (built < steps) {
    if (built > 0) {
      orthogonalize(basis, built, along, v);
    }
    const double length = v.norm();
    if (!(length > 1e-12 * scale)) {
      break;
    }
    basis.col(built) = v / length;
    v = apply(basis.col(built));
    scale = std::max(scale, v.norm());
    along = coefficients_of(basis, built + 1, v);
    small.col(built).head(built + 1) = along;
    ++built;
    if (built % kLanczosCheck == 0) {
      const double before = found.value;
      found = pick(small.topLeftCorner(built, built), negative);
      if (std::abs(found.value - before) <=
          kLanczosAccuracy * std::abs(found.value)) {
        break;
      }
    }
  }
  if (built > 0) {
    found = pick(small.topLeftCorner(built, built), negative);
    found.vector = basis.leftCols(built) * found.vector;
  }
  return found;
}

}  // namespace

ConstrainedHessian::ConstrainedHessian(const SparseMatrix& pattern,
                                       const std::vector<int>& order)
    : factor_(pattern, FactorKind::Indefinite, order) {}

bool ConstrainedHessian::factorize(const SparseMatrix& hessian,
                                   const VectorX& metric, double shift,
                                   const Eigen::MatrixXd& constraints) {
  SparseMatrix matrix = hessian;
  double diagonal = 0.0;
  const auto add = [&](const VectorX& d) {
    for (int i = 0; i < matrix.cols(); ++i) {
      matrix.valuePtr()[matrix.outerIndexPtr()[i]] += d[i];
    }
  };
  for (int i = 0; i < matrix.cols(); ++i) {
    diagonal += std::abs(matrix.valuePtr()[matrix.outerIndexPtr()[i]]);
  }
  if (!std::isfinite(matrix.coeffs().sum())) {
    return false;
  }
  // A + shift M, M the metric: lifts the spectrum where a minimum is sought.
  if (shift > 0.0) {
    add(shift * metric);
  }
  const auto n = static_cast<double>(std::max<Eigen::Index>(1, matrix.cols()));
  // L D L' without pivoting; a zero pivot is cured by a small multiple of the
  // mean diagonal.
  for (int attempt = 0; !factor_.factorize(matrix); ++attempt) {
    if (attempt == 3) {
      return false;
    }
    add(VectorX::Constant(matrix.cols(), kPivotShift * diagonal / n));
  }
  constraints_ = constraints;
  const auto m = static_cast<int>(constraints.cols());
  // Sylvester: the negative pivots in D are the negative eigenvalues of A.
  index_ = factor_.negative_pivots();
  if (m == 0) {
    return true;
  }
  // B' A^-1 B, the Schur complement of the saddle system up to its sign.
  inverse_constraints_ = factor_.solve(constraints_);
  Eigen::MatrixXd schur = constraints_.transpose() * inverse_constraints_;
  schur = 0.5 * (schur + schur.transpose()).eval();
  // Columns of different size (volume gradients, translations): scale first.
  const VectorX scale = constraints_.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * schur *
                                 scale.cwiseInverse().asDiagonal();
  if (!scaled.allFinite()) {
    return false;
  }
  // Pseudo-inverse by its eigenvalues. Positive ones are the negative ones of
  // S = -B' A^-1 B, hence index = neg(A) + neg(S) - m (Nocedal, Wright 2006,
  // theorem 16.3).
  const auto eigen = symmetric_eigen(scaled);
  VectorX inverse = eigen.values;
  const double largest = inverse.cwiseAbs().maxCoeff();
  int positive = 0;
  for (double& value : inverse) {
    positive += value > 0.0 ? 1 : 0;
    value = std::abs(value) > 1e-14 * largest ? 1.0 / value : 0.0;
  }
  schur_inverse_ =
      scale.cwiseInverse().asDiagonal() *
      (eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose()) *
      scale.cwiseInverse().asDiagonal();
  index_ += positive - m;
  return true;
}

ConstrainedHessian::Step ConstrainedHessian::solve(
    const VectorX& residual, const VectorX& missing) const {
  Step step;
  const VectorX plain = factor_.solve(residual);
  step.dh = -plain;
  step.dp.resize(constraints_.cols());
  if (constraints_.cols() > 0) {
    step.dp = schur_inverse_ * (missing + constraints_.transpose() * plain);
    step.dh += inverse_constraints_ * step.dp;
    // One correction keeps the constraint to rounding.
    const VectorX left = missing - constraints_.transpose() * step.dh;
    const VectorX more = schur_inverse_ * left;
    step.dp += more;
    step.dh += inverse_constraints_ * more;
  }
  return step;
}

VectorX ConstrainedHessian::restore(const VectorX& missing) const {
  return inverse_constraints_ * (schur_inverse_ * missing);
}

double ConstrainedHessian::stiffness(Eigen::Index count) const {
  return count > 0 ? schur_inverse_.diagonal().head(count).cwiseAbs().maxCoeff()
                   : 0.0;
}

VectorX ConstrainedHessian::constrained_inverse(const VectorX& right) const {
  VectorX result = factor_.solve(right);
  if (constraints_.cols() > 0) {
    result -= inverse_constraints_ *
              (schur_inverse_ * (constraints_.transpose() * result));
  }
  return result;
}

LowestMode ConstrainedHessian::lowest_mode(const VectorX& metric) const {
  // Symmetric form: with D = sqrt(metric), D P D has eigenvalues 1 / lambda,
  // where P is the inverse on the constraint space.
  LowestMode result;
  const VectorX root = metric.cwiseMax(1e-300).cwiseSqrt();
  const auto apply = [&](const VectorX& v) -> VectorX {
    return root.cwiseProduct(constrained_inverse(root.cwiseProduct(v)));
  };
  const RitzPair found = lanczos(apply, metric.size(), index_);
  if (found.value == 0.0) {
    return result;
  }
  result.eigenvalue = 1.0 / found.value;
  result.mode = found.vector.cwiseQuotient(root);
  Eigen::Index at = 0;
  if (result.mode.cwiseAbs().maxCoeff(&at) > 0.0) {
    result.mode /= result.mode[at];
  }
  return result;
}

}  // namespace meniscus::energy
