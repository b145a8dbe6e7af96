/// Preconditioned conjugate gradients for up to four right-hand sides in step:
/// each product and each preconditioner reads its matrix once for all of them.
#pragma once

#include <vector>

#include "core/monitor.h"
#include "fea/solver/block_matrix.h"
#include "fea/solver/preconditioner.h"

namespace meniscus::solver {

inline constexpr int kMostColumns = 4;

struct CgProblem {
  const BlockPattern& pattern;
  const BlockMatrix<double>& matrix;
  const Preconditioner& preconditioner;
  const NodeFreedom& freedom;  // held directions stay 0
  /// Of each solution, relative, in the energy norm: sqrt(r . M r / u . A u),
  /// the error itself where the preconditioner M is the inverse.
  double tolerance = 1e-10;
  int max_iterations = 400;
  Monitor& monitor;
};

enum class CgEnd { Converged, TooManyIterations, NotPositive, NotFinite };

struct CgColumn {
  CgEnd end = CgEnd::Converged;
  int iterations = 0;
  double error = 0.0;  // relative, in the energy norm, estimated
};

/// Solves A u = f on the free directions. `f`, `u`: K <= kMostColumns vectors,
/// 3 per node, solver's numbering; `u` holds the start and becomes
/// the solution. Textbook algorithm: Saad, Iterative Methods for Sparse Linear
/// Systems, 2003, algorithm 9.1. Throws Interrupted when the monitor asks.
std::vector<CgColumn> conjugate_gradients(const CgProblem& problem,
                                          const std::vector<VectorX>& f,
                                          std::vector<VectorX>& u);

}  // namespace meniscus::solver
