/// Chebyshev's iteration: the polynomial in M A that is smallest on an interval
/// (Saad 2003, algorithm 12.1). Fixed in advance, so that what it makes of a
/// symmetric preconditioner is symmetric again.
#pragma once

#include <vector>

namespace meniscus::solver {

/// Steps x += d, r -= A d with d = keep d + take M r.
struct ChebyshevStep {
  double keep = 0.0;
  double take = 1.0;
};

/// The fewest steps, at most `most`, that reduce every error of M A's
/// eigenvalues in [lowest, highest] to `reduction`. 0 < lowest <= highest,
/// 0 < reduction < 1.
std::vector<ChebyshevStep> chebyshev_steps(double lowest, double highest,
                                           double reduction, int most);

/// Eigenvalues of a symmetric tridiagonal matrix, the lowest: of Lanczos'
/// process, from the coefficients of conjugate gradients (Golub, Van Loan
/// 2013, 10.2): step k's alpha = r.z / p.A p and beta = r.z / the last r.z
/// (beta[0] unused).
double lowest_ritz_value(const std::vector<double>& alpha,
                         const std::vector<double>& beta);

}  // namespace meniscus::solver
