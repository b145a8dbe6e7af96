/// ElasticModel's part for SolverKind::Distributed: no matrix is assembled
/// here.
#pragma once

#include <optional>
#include <vector>

#include "fea/distributed/petsc_cut.h"
#include "fea/equations/elastic_base.h"
#include "fea/solver/assembly.h"

namespace meniscus::distributed {

class DistributedSystem {
 public:
  /// Checks the input, orders the mesh, groups load cases that are held alike.
  /// Throws what ElasticModel throws.
  DistributedSystem(const TetMesh& base,
                    const std::vector<element::Material>& materials,
                    const std::vector<loads::LoadCase>& load_cases,
                    const equations::ElasticOptions& options);

  const equations::ElasticBase& base() const { return base_; }

  /// Solves all load cases in processes of their own; `start`: a solution to
  /// begin from, or null (the base itself).
  equations::ElasticSolution solve(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      const equations::RegionMaterials& regions,
      const equations::ElasticSolution* start) const;

 private:
  std::optional<Failure> bad_design(const TetMesh& mesh, const Points& x) const;
  int processes() const;
  /// What holds each group; the base's own where `mesh` is the base.
  std::optional<Failure> hold(
      const TetMesh& mesh, const std::vector<loads::LoadCase>& load_cases,
      bool is_base, std::vector<supports::Restraints>& restraints) const;
  /// Points into its arguments.
  std::vector<PetscGroup> grouped(
      const std::vector<supports::Restraints>& restraints,
      const std::vector<VectorX>& f, const std::vector<VectorX>& start) const;

  equations::ElasticBase base_;
  solver::ElementTable table_;
  std::vector<equations::HeldCases> groups_;
};

}  // namespace meniscus::distributed
