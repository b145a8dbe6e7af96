#include "fea/equations/held_solver.h"

#include <algorithm>

#include "fea/solver/multi_vector.h"

namespace meniscus::equations {

std::vector<solver::CgColumn> HeldSolver::solve_with(
    const solver::Preconditioner& preconditioner, int max_iterations,
    const std::vector<VectorX>& f, std::vector<VectorX>& u) const {
  return solver::conjugate_gradients({.pattern = in_.pattern,
                                      .matrix = in_.matrix,
                                      .preconditioner = preconditioner,
                                      .freedom = in_.restraints.freedom,
                                      .tolerance = in_.tolerance,
                                      .max_iterations = max_iterations,
                                      .monitor = in_.monitor},
                                     f, u);
}

std::vector<solver::CgColumn> HeldSolver::solve_few(
    const std::vector<VectorX>& f, std::vector<VectorX>& u) {
  const int unknowns = supports::free_unknowns(in_.restraints);
  if (unknowns > solver::kSecondChance) {
    return solve_with(in_.preconditioner, in_.max_iterations, f, u);
  }
  if (factor_ == nullptr) {
    std::vector<solver::CgColumn> columns = solve_with(
        in_.preconditioner, std::min(in_.max_iterations, in_.patience), f, u);
    // A direction of negative curvature means a cycle that is not positive.
    const bool slow = in_.patience < in_.max_iterations;
    const bool lost = std::any_of(
        columns.begin(), columns.end(), [&](const solver::CgColumn& column) {
          return column.end == solver::CgEnd::NotPositive ||
                 (slow && column.end == solver::CgEnd::TooManyIterations);
        });
    if (!lost) {
      return columns;
    }
    for (VectorX& v : u) {
      v.setZero();
    }
    factor_ =
        solver::make_direct(in_.pattern, in_.matrix, in_.restraints.freedom);
  }
  return solve_with(*factor_, in_.max_iterations, f, u);
}

std::vector<solver::CgColumn> HeldSolver::solve(const std::vector<VectorX>& f,
                                                std::vector<VectorX>& u) {
  std::vector<solver::CgColumn> columns;
  constexpr auto kStep = static_cast<std::ptrdiff_t>(solver::kMostColumns);
  const auto count = static_cast<std::ptrdiff_t>(f.size());
  for (std::ptrdiff_t first = 0; first < count; first += kStep) {
    const std::ptrdiff_t last = std::min(first + kStep, count);
    std::vector<VectorX> some(u.begin() + first, u.begin() + last);
    const std::vector<solver::CgColumn> found =
        solve_few({f.begin() + first, f.begin() + last}, some);
    std::move(some.begin(), some.end(), u.begin() + first);
    columns.insert(columns.end(), found.begin(), found.end());
  }
  return columns;
}

VectorX HeldSolver::product(const VectorX& v) const {
  const solver::NodeFreedom all{in_.pattern.nodes, {}, {}};
  solver::Columns result(v.size(), 1);
  solver::ColumnProducts(in_.pattern, all).apply(in_.matrix, v, result);
  return result.col(0);
}

}  // namespace meniscus::equations
