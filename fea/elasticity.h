/// Linear static elasticity on tetrahedra.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/monitor.h"
#include "core/tet_mesh.h"
#include "fea/elastic_adjoint.h"
#include "fea/loads.h"
#include "fea/material.h"
#include "fea/stress.h"

namespace meniscus {

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

struct ElasticOperator;

/// The elasticity of one mesh topology. Built once at the base design:
/// sparsity, orderings, factors and smoother. solve() then assembles the
/// stiffness of any mesh of the same topology and solves it by conjugate
/// gradients preconditioned with the base's factors, from the base's solution:
/// a pure function of (base, mesh, loads), safe to call from several threads.
///
/// With SolverKind::Distributed this process assembles no matrix: each design
/// is handed to the helper `meniscus-petsc` in several processes, started by
/// mpirun, that assemble and solve it (fea/petsc_child.h). Constructor and
/// solve() then throw IoError too (helper or mpirun missing, temporary folder)
/// and SolverError when a process dies.
class ElasticModel {
 public:
  /// `materials`: one per region of the mesh. Throws InvalidInput (material,
  /// unknown surface, no support, no load), MeshError (inverted element) and
  /// SolverError (supports too weak: names the free motion; memory). A base
  /// that does not converge is told in base_solution().failure.
  ElasticModel(const TetMesh& base, const std::vector<Material>& materials,
               std::vector<LoadCase> load_cases,
               const ElasticOptions& options = {});
  ~ElasticModel();
  ElasticModel(ElasticModel&&) noexcept;
  ElasticModel& operator=(ElasticModel&&) noexcept;

  /// The base mesh's own solution.
  const ElasticSolution& base_solution() const;

  /// A mesh with the base's elements and other node positions. Throws
  /// InvalidInput when elements, faces or names differ from the base's.
  ElasticSolution solve(const TetMesh& mesh) const;

  /// The same under other loads; names and supports must be the base's.
  ElasticSolution solve(const TetMesh& mesh,
                        const std::vector<LoadCase>& load_cases) const;

  /// The same, and `keep` (not null) is given what solve_adjoint() needs of
  /// this design; it is left empty when the solve fails.
  ElasticSolution solve(const TetMesh& mesh,
                        const std::vector<LoadCase>& load_cases,
                        ElasticState* keep) const;

  /// The same of other materials, one per region; the preconditioner stays the
  /// base's. Throws InvalidInput for another number of them, too.
  ElasticSolution solve(const TetMesh& mesh,
                        const std::vector<LoadCase>& load_cases,
                        const std::vector<Material>& materials,
                        ElasticState* keep) const;

  /// Adjoints of load case `load_case` (index), several at once: K lambda = g
  /// for each right-hand side g, 3 per node of the mesh, by the solver and to
  /// the tolerance of solve(). Not to converge is a failure. Throws
  /// InvalidInput for an empty state and sizes that do not fit.
  AdjointSolution solve_adjoint(
      const ElasticState& state, int load_case,
      const std::vector<VectorX>& right_hand_sides) const;

  /// The stiffness of `mesh`, held as in load case `load_case` (index), for
  /// eigenvalue problems; it must not outlive the model. Throws InvalidInput as
  /// solve() does or for a distributed model, MeshError (inverted element) and
  /// SolverError (supports that turned against each other). `materials`: one
  /// per region; null: the base's.
  ElasticOperator operator_at(const TetMesh& mesh,
                              const std::vector<LoadCase>& load_cases,
                              int load_case,
                              const std::vector<Material>* materials) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus
