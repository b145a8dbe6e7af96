/// The equations of a design on the directions that supports leave free.
#pragma once

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
  /// A factor in double precision where a preconditioner in single precision
  /// is lost, on supports that hardly hold.
  bool second_chance = true;
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
  bool took_factor() const { return took_factor_; }

 private:
  std::vector<solver::CgColumn> solve_with(
      const solver::Preconditioner& preconditioner,
      const std::vector<VectorX>& f, std::vector<VectorX>& u) const;
  std::vector<solver::CgColumn> solve_few(const std::vector<VectorX>& f,
                                          std::vector<VectorX>& u);

  const HeldEquations in_;
  bool took_factor_ = false;
};

}  // namespace meniscus::equations
