/// Newton's linear system for films whose bodies hold volumes, and what its
/// factor tells about stability. With H the Hessian of E - sum p V and the
/// columns of B the volume gradients,
///
///   [ H   -B ] [dh]   [-r]      r: residual, c: volume still missing
///   [ B^T  0 ] [dp] = [ c]
///
/// is solved through the Schur complement S = B^T H^-1 B. By Sylvester's law
/// the number of negative eigenvalues of H on the space B^T dh = 0 is
///   index = negative(H) + positive(S) - columns(B),
/// (Gould 1985); a column that S cannot resolve counts as not positive.
#pragma once

#include "core/error.h"
#include "core/math/linear_solve.h"

namespace meniscus::energy {

struct LowestMode {
  double eigenvalue = 0.0;  // in the metric given [1/metric of H]
  VectorX mode;             // largest entry 1
};

struct LowestModes {
  VectorX eigenvalues;    // ascending
  Eigen::MatrixXd modes;  // columns v with v' diag(metric) v = 1
};

/// A film has no modes, or they were not found: nothing that the machine
/// refused, but what this film answers.
class ModesNotFound : public SolverError {
 public:
  using SolverError::SolverError;
};

class ConstrainedHessian {
 public:
  ConstrainedHessian(const SparseMatrix& pattern,
                     const std::vector<int>& order);

  /// Factors H + shift diag(metric) with `constraints` (n x m). A pivot that
  /// is exactly zero is moved off it by 1e-12 of the mean diagonal. False
  /// when H is not finite.
  bool factorize(const SparseMatrix& hessian, const VectorX& metric,
                 double shift, const Eigen::MatrixXd& constraints);

  /// Negative eigenvalues on the constraint space, of the matrix factored.
  int index() const { return index_; }

  struct Step {
    VectorX dh;
    VectorX dp;  // one per constraint
  };
  Step solve(const VectorX& residual, const VectorX& missing) const;
  /// The cheapest dh in the factored Hessian with B^T dh = missing.
  VectorX restore(const VectorX& missing) const;
  /// Largest |dp/dV| of S^-1 over the first `count` constraints.
  double stiffness(Eigen::Index count) const;

  /// Lowest eigenvalue of H x = lambda diag(metric) x on the constraint space
  /// by Lanczos on the inverse, fixed start vector, full orthogonalisation.
  LowestMode lowest_mode(const VectorX& metric) const;

  /// The `count` lowest of a positive definite Hessian (index 0, not shifted)
  /// to rounding, copies of equal ones included: Rayleigh and Ritz on the
  /// block Krylov space of the inverse. Fewer where there are fewer. Throws
  /// ModesNotFound where they are not found.
  LowestModes lowest_modes(const VectorX& metric, int count) const;

 private:
  VectorX constrained_inverse(const VectorX& right) const;

  SymmetricFactor factor_;
  Eigen::MatrixXd constraints_;
  Eigen::MatrixXd inverse_constraints_;  // H^-1 B
  Eigen::MatrixXd schur_inverse_;
  int index_ = 0;
};

}  // namespace meniscus::energy
