/// Dense Cholesky factors that stop on the way: fronts of multifrontal
/// elimination (Duff and Reid 1983; Liu, SIAM Review 34, 1992).
#pragma once

#include <Eigen/Core>

namespace meniscus {

/// Eliminates the first unknowns of a symmetric matrix, of which the lower
/// triangle is read. `leading`: their columns, in which L stands afterwards;
/// `rest`: the square below and right of them, in whose lower triangle the
/// Schur complement stands then; what is above either diagonal has no meaning.
/// Two arrays, so that one can be dropped without a copy of the other. False
/// where a pivot is not positive. The same bits for any number of threads.
bool eliminate_leading(Eigen::MatrixXd& leading, Eigen::MatrixXd& rest);

/// L^-1 b of the leading columns, in place: b's first rows become y, the others
/// lose L_21 y. `L`: the columns that eliminate_leading() left.
void solve_leading_lower(const Eigen::MatrixXd& L, Eigen::MatrixXd& b);

/// L_11^-T (y - L_21^T x): b has y, and below it the others' x; y becomes x.
void solve_leading_upper(const Eigen::MatrixXd& L, Eigen::MatrixXd& b);

}  // namespace meniscus
