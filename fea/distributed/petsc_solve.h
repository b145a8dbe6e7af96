/// Conjugate gradients with PETSc's algebraic multigrid (GAMG), whose coarse
/// spaces hold the rigid motions.
#pragma once

#include <vector>

#include "fea/distributed/petsc_matrix.h"

namespace meniscus::distributed::petsc {

struct SolvedColumn {
  CaseResult result;
  std::vector<double> u;  // 3 per own node [length]
};

struct SolvedGroup {
  std::vector<double> diagonal;  // of the matrix, 3 per own node
  std::vector<SolvedColumn> columns;
};

struct SolvedPiece {
  std::vector<SolvedGroup> groups;
  double setup_seconds = 0.0;  // matrices and multigrid levels
  double solve_seconds = 0.0;
};

/// Collective: every process calls it with its own piece. The same tolerance
/// as the program's own solver (fea/solver/conjugate_gradients.h): sqrt(r . M r
/// / u . f). Options of PETSc's (PETSC_OPTIONS) go before those chosen here.
SolvedPiece solve_piece(const Piece& piece);

}  // namespace meniscus::distributed::petsc
