/// The equations of a design on the directions that supports leave free.
#pragma once

#include <memory>
#include <vector>

#include "core/monitor.h"
#include "fea/solver/conjugate_gradients.h"
#include "fea/supports/restraints.h"

namespace meniscus::equations {

/// Nothing is owned; all in the solver's numbering.
struct HeldEquations {
  const solver::BlockPattern& pattern;
  const solver::BlockMatrix<double>& matrix;  // K + S, with springs
  const solver::Preconditioner& preconditioner;
  const supports::Restraints& restraints;
  double tolerance = 1e-10;
  int max_iterations = 400;
  Monitor& monitor;
  /// Iterations after which a factor of this matrix takes over, up to
  /// solver::kSecondChance unknowns; not where it is max_iterations or more.
  int patience = 0;
};

class HeldSolver {
 public:
  explicit HeldSolver(const HeldEquations& equations) : in_(equations) {}

  /// (K + S) u = f, the nodes of pins held, by preconditioned conjugate
  /// gradients (Hestenes, Stiefel 1952), kMostColumns in step. `u` holds the
  /// starts and becomes the solutions.
  std::vector<solver::CgColumn> solve(const std::vector<VectorX>& f,
                                      std::vector<VectorX>& u);

  /// (K + S) v, along held directions too.
  VectorX product(const VectorX& v) const;

  const supports::Restraints& restraints() const { return in_.restraints; }
  /// Of the matrix, where the preconditioner did not serve; else null.
  std::shared_ptr<const solver::Preconditioner> factor() const {
    return factor_;
  }

 private:
  std::vector<solver::CgColumn> solve_with(
      const solver::Preconditioner& preconditioner, int max_iterations,
      const std::vector<VectorX>& f, std::vector<VectorX>& u) const;
  std::vector<solver::CgColumn> solve_few(const std::vector<VectorX>& f,
                                          std::vector<VectorX>& u);

  const HeldEquations in_;
  std::shared_ptr<const solver::Preconditioner> factor_;
};

}  // namespace meniscus::equations
