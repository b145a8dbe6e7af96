/// How elasticity is solved, and what that gives.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "core/types.h"

namespace meniscus::equations {

struct ElasticReport {
  int dofs = 0;                     // free unknowns of the first load case
  std::string solver;               // "p-multigrid", "cholmod", "petsc"
  int iterations = 0;               // of the last load case
  double residual = 0.0;            // relative, largest over load cases
  double strain_energy = 0.0;       // of the first load case [force length]
  double reaction_imbalance = 0.0;  // |reactions + loads| / |loads|
  double setup_seconds = 0.0;       // checks, assembly, preconditioner
  double solve_seconds = 0.0;
  double stress_seconds = 0.0;  // of the caller's recover_stress, if it tells
  /// Peak memory of each process of a distributed solve [byte].
  std::vector<double> process_memory;
};

/// Nodal displacement [length], 3 per node, per load case; reactions [force],
/// zero where nothing is fixed.
struct ElasticSolution {
  std::vector<VectorX> displacements;
  std::vector<VectorX> reactions;
  ElasticReport report;
  std::optional<Failure> failure;
};

enum class SolverKind {
  Automatic,
  Cholesky,
  Multigrid,
  Distributed  // PETSc in processes of its own, each with a part of the matrix
};
inline constexpr int kMostProcesses = 4096;

struct ElasticOptions {
  /// Automatic: multigrid above 1,000 unknowns, else Cholesky.
  SolverKind solver = SolverKind::Automatic;
  /// Of Distributed, 1 to kMostProcesses; fewer are started where one would
  /// have less than 100 nodes.
  int processes = 2;
  /// Of Distributed: wall clock of one solve of all load cases [s]; without it
  /// 600 s and 1 ms an unknown and load case.
  std::optional<double> time_limit;
  /// Relative error of the displacement in the energy norm, per load case, as
  /// the preconditioner estimates it.
  double tolerance = 1e-10;
  int max_iterations = 400;
  Monitor* monitor = nullptr;  // not owned; must outlive the model
};

}  // namespace meniscus::equations
