#include "optimize/quadratic/nonnegative_least_squares.h"

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "core/heed_stop.h"
#include "core/math/dense.h"

namespace meniscus::quadratic {
namespace {

// A gradient entry below this x the largest one is rounding.
constexpr double kRounding = 1e-14;

// The least-squares solution over the columns in `used`, 0 elsewhere.
VectorX solve_on(const Eigen::MatrixXd& A, const VectorX& b,
                 const std::vector<Eigen::Index>& used) {
  Eigen::MatrixXd part(A.rows(), static_cast<Eigen::Index>(used.size()));
  for (std::size_t k = 0; k < used.size(); ++k) {
    part.col(static_cast<Eigen::Index>(k)) = A.col(used[k]);
  }
  const VectorX found = least_squares(part, b).x;
  VectorX x = VectorX::Zero(A.cols());
  for (std::size_t k = 0; k < used.size(); ++k) {
    x[used[k]] = found[static_cast<Eigen::Index>(k)];
  }
  return x;
}

// Moves x towards z until the first entry becomes 0; frees those at 0.
void step_back(const VectorX& z, VectorX& x, std::vector<Eigen::Index>& used) {
  double part = 1.0;
  for (const Eigen::Index j : used) {
    if (z[j] <= 0.0) {
      part = std::min(part, x[j] / (x[j] - z[j]));
    }
  }
  const VectorX before = x;
  x += part * (z - x);
  std::vector<Eigen::Index> kept;
  kept.reserve(used.size());
  for (const Eigen::Index j : used) {
    const bool reached =
        z[j] <= 0.0 && before[j] <= part * (before[j] - z[j]) * (1.0 + 1e-12);
    if (reached) {
      x[j] = 0.0;
    } else {
      kept.push_back(j);
    }
  }
  used = std::move(kept);
}

}  // namespace

VectorX nonnegative_least_squares(const Eigen::MatrixXd& A, const VectorX& b) {
  VectorX x = VectorX::Zero(A.cols());
  if (A.cols() == 0) {
    return x;
  }
  const double small =
      kRounding * std::max(1.0, (A.transpose() * b).cwiseAbs().maxCoeff());
  std::vector<Eigen::Index> used;
  std::vector<bool> barred(static_cast<std::size_t>(A.cols()), false);
  for (Eigen::Index round = 0; round < 3 * A.cols() + 10; ++round) {
    heed_stop("optimize");
    const VectorX gain = A.transpose() * (b - A * x);
    Eigen::Index next = -1;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      const bool in = std::find(used.begin(), used.end(), j) != used.end();
      if (!in && !barred[static_cast<std::size_t>(j)] && gain[j] > small &&
          (next < 0 || gain[j] > gain[next])) {
        next = j;
      }
    }
    if (next < 0) {
      break;
    }
    used.push_back(next);
    VectorX z = solve_on(A, b, used);
    // A column that depends on those used gains by rounding only.
    barred[static_cast<std::size_t>(next)] = z[next] <= 0.0;
    while (!used.empty() &&
           std::any_of(used.begin(), used.end(),
                       [&](Eigen::Index j) { return z[j] <= 0.0; })) {
      step_back(z, x, used);
      z = solve_on(A, b, used);
    }
    x = z;
  }
  return x;
}

}  // namespace meniscus::quadratic
