/// Extreme eigenpairs of A x = theta K x, with K a stiffness matrix: the one
/// problem behind natural frequencies (A = M, theta = 1 / omega^2) and buckling
/// factors (A = -K_g, theta = 1 / lambda).
#pragma once

#include <functional>

#include "core/monitor.h"
#include "fea/solver/multi_vector.h"

namespace meniscus::modes {

/// y = a matrix times x, column by column, in the space that the modes are in;
/// `x` is in it but for what a preconditioner is given.
using ColumnOperator = std::function<void(const solver::ColumnsIn& x,
                                          const solver::ColumnsOut& y)>;

/// `K` must be positive definite on the space, `preconditioner` an
/// approximation of its inverse there.
struct EigenProblem {
  Eigen::Index rows = 0;       // of a vector
  Eigen::Index dimension = 0;  // of the space that the modes are in
  ColumnOperator K, A, preconditioner;
  std::function<void(const solver::ColumnsOut& v)> project;  // onto the space
};

struct EigenOptions {
  int count = 1;  // of the largest (signed) theta
  /// Bound of the residual, see EigenPairs; theta's own error is about its
  /// square over the relative gap.
  double tolerance = 1e-6;
  /// Eigenvalues below this need only be known to be so: where A has no
  /// positive one, theta creeps towards 0 and nothing else would end it.
  double floor = 0.0;
  /// Vectors beyond `count`: they lift convergence off the gap behind the last
  /// one, and catch eigenvalues that are nearly equal.
  int guards = 2;
  int max_iterations = 200;
  Monitor* monitor = nullptr;  // not owned
};

enum class EigenEnd { Converged, TooManyIterations, NotPositive, NotFinite };

struct EigenPairs {
  EigenEnd end = EigenEnd::Converged;
  VectorX theta;      // descending; fewer than asked for when there are fewer
  solver::Columns x;  // one a column, x^T K x = 1
  VectorX residuals;  // |A x - theta K x| in the norm of the preconditioner
                      // (near that of K^-1), over max(|theta|, floor): some
                      // eigenvalue is no farther than this from theta
  int iterations = 0;
};

/// Preconditioned block conjugate gradients (Knyazev, Toward the optimal
/// preconditioned eigensolver: LOBPCG, SIAM J. Sci. Comput. 23, 2001; basis as
/// in Hetmaniuk and Lehoucq, J. Comput. Phys. 218, 2006): a product and a
/// preconditioner per vector and iteration, no inner solves. `start`: vectors
/// to begin with, may have no columns; the rest of the block begins with fixed
/// pseudo-random numbers. The same bits for any number of threads. Throws
/// Interrupted when the monitor asks.
EigenPairs largest_eigenpairs(const EigenProblem& problem,
                              const solver::Columns& start,
                              const EigenOptions& options);

}  // namespace meniscus::modes
