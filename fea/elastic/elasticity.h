/// Linear static elasticity on tetrahedra.
#pragma once

#include <memory>
#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/material.h"
#include "fea/equations/elastic_adjoint.h"
#include "fea/equations/elastic_solution.h"
#include "fea/loads/loads.h"
#include "fea/stress/stress.h"

namespace meniscus::equations {
struct ElasticOperator;
}

namespace meniscus::elastic {

/// The elasticity of one mesh topology. Built once at the base design:
/// sparsity, orderings, factors and smoother. solve() then assembles the
/// stiffness of any mesh of the same topology and solves it by conjugate
/// gradients preconditioned with the base's factors, from the base's solution:
/// a pure function of (base, mesh, loads), safe to call from several threads.
///
/// With SolverKind::Distributed this process assembles no matrix: each design
/// is handed to the helper `meniscus-petsc` in several processes, started by
/// mpirun, that assemble and solve it (fea/distributed/petsc_child.h).
/// Constructor and solve() then throw IoError too (helper or mpirun missing,
/// temporary folder) and SolverError when a process dies.
class ElasticModel {
 public:
  /// `materials`: one per region of the mesh. Throws InvalidInput (material,
  /// unknown surface, no support, no load), MeshError (inverted element) and
  /// SolverError (supports too weak: names the free motion; memory). A base
  /// that does not converge is told in base_solution().failure.
  ElasticModel(const TetMesh& base,
               const std::vector<element::Material>& materials,
               std::vector<loads::LoadCase> load_cases,
               const equations::ElasticOptions& options = {});
  ~ElasticModel();
  ElasticModel(ElasticModel&&) noexcept;
  ElasticModel& operator=(ElasticModel&&) noexcept;

  /// The base mesh's own solution.
  const equations::ElasticSolution& base_solution() const;

  /// A mesh with the base's elements and other node positions. Throws
  /// InvalidInput when elements, faces or names differ from the base's.
  equations::ElasticSolution solve(const TetMesh& mesh) const;

  /// The same under other loads; names, supports and pins must be the base's,
  /// but for the numbers that these enforce.
  equations::ElasticSolution solve(
      const TetMesh& mesh,
      const std::vector<loads::LoadCase>& load_cases) const;

  /// The same, and `keep` (not null) is given what solve_adjoint() needs of
  /// this design; it is left empty when the solve fails.
  equations::ElasticSolution solve(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      equations::ElasticState* keep) const;

  /// The same of other materials, one per region; the preconditioner stays the
  /// base's. Throws InvalidInput for another number of them, too.
  equations::ElasticSolution solve(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      const std::vector<element::Material>& materials,
      equations::ElasticState* keep) const;

  /// Adjoints, several at once: K lambda = g for each right-hand side g, 3 per
  /// node of the mesh, held as in the load case of the same place in
  /// `load_cases` (indices), by the solver and to the tolerance of solve(). Of
  /// load cases held alike up to four (kMostColumns) are solved in step. Not to
  /// converge is a failure. Throws InvalidInput for an empty state and sizes
  /// that do not fit.
  equations::AdjointSolution solve_adjoints(
      const equations::ElasticState& state, const std::vector<int>& load_cases,
      const std::vector<VectorX>& right_hand_sides) const;

  /// The same, all of one load case.
  equations::AdjointSolution solve_adjoint(
      const equations::ElasticState& state, int load_case,
      const std::vector<VectorX>& right_hand_sides) const;

  /// The stiffness of `mesh`, held as in load case `load_case` (index), for
  /// eigenvalue problems; it must not outlive the model. Throws InvalidInput as
  /// solve() does, for rigid pins or for a distributed model, MeshError
  /// (inverted element) and SolverError (supports that turned against each
  /// other). `materials`: one per region; null: the base's.
  equations::ElasticOperator operator_at(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      int load_case, const std::vector<element::Material>* materials) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus::elastic
