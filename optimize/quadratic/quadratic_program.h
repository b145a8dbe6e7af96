/// A convex quadratic over a box and linear inequalities: one step of a search
/// that knows its function by a model.
#pragma once

#include <limits>
#include <optional>

#include "core/types.h"

namespace meniscus::quadratic {

/// 1e-7 of the variables is nothing.
/// min slope . d + d . hessian d / 2  over  low <= d <= high, rows d <= limits.
struct QuadraticProgram {
  Eigen::MatrixXd hessian;  // n x n, symmetric, positive definite
  VectorX slope;            // n
  VectorX low;              // n, may be -infinity
  VectorX high;             // n, >= low, may be infinity
  Eigen::MatrixXd rows;     // m x n; an equation is two of them
  VectorX limits;           // m

  /// Adds row . d <= limit.
  void add(const VectorX& row, double limit);
};

struct QuadraticAnswer {
  VectorX step;         // n, within the box to the bit
  VectorX multipliers;  // m, >= 0, of `rows`
};

/// The minimiser, as the point of least norm in coordinates in which the
/// hessian is 1, which is a problem of nonnegative least squares (Lawson &
/// Hanson, Solving Least Squares Problems, 1974, chapter 23). Nothing where the
/// inequalities exclude each other or the hessian is not positive. Same input,
/// same bits.
std::optional<QuadraticAnswer> solve_quadratic(const QuadraticProgram& program);

/// By what each row has to be missed, at least in the sum of squares, for all
/// to be kept within the box: 0 where they can be kept [m].
VectorX least_misses(const QuadraticProgram& program);

}  // namespace meniscus::quadratic
