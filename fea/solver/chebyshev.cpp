#include "fea/solver/chebyshev.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "core/math/dense.h"

namespace meniscus::solver {

std::vector<ChebyshevStep> chebyshev_steps(double lowest, double highest,
                                           double reduction, int most) {
  const double middle = 0.5 * (highest + lowest);
  const double half = std::max(0.5 * (highest - lowest), 1e-3 * middle);
  const double sigma = middle / half;
  const double wanted = std::acosh(1.0 / reduction) / std::acosh(sigma);
  const int count = static_cast<int>(
      std::clamp(std::ceil(wanted), 1.0, static_cast<double>(most)));
  std::vector<ChebyshevStep> steps = {{0.0, 1.0 / middle}};
  double rho = 1.0 / sigma;
  while (static_cast<int>(steps.size()) < count) {
    const double next = 1.0 / (2.0 * sigma - rho);
    steps.push_back({next * rho, 2.0 * next / half});
    rho = next;
  }
  return steps;
}

double lowest_ritz_value(const std::vector<double>& alpha,
                         const std::vector<double>& beta) {
  const auto n = static_cast<Eigen::Index>(alpha.size());
  Eigen::VectorXd diagonal(n);
  Eigen::VectorXd beside(std::max<Eigen::Index>(n - 1, 0));
  for (Eigen::Index k = 0; k < n; ++k) {
    diagonal[k] = 1.0 / alpha[k] + (k > 0 ? beta[k] / alpha[k - 1] : 0.0);
    if (k > 0) {
      beside[k - 1] = std::sqrt(beta[k]) / alpha[k - 1];
    }
  }
  return tridiagonal_eigenvalues(diagonal, beside)[0];
}

}  // namespace meniscus::solver
