/// ElasticModel's part for SolverKind::Distributed: no matrix is assembled
/// here.
#pragma once

#include <optional>
#include <vector>

#include "fea/distributed/petsc_cut.h"
#include "fea/equations/elastic_base.h"
#include "fea/solver/assembly.h"

namespace meniscus {

class DistributedSystem {
 public:
  /// Checks the input, orders the mesh, groups load cases that are held alike.
  /// Throws what ElasticModel throws.
  DistributedSystem(const TetMesh& base, const std::vector<Material>& materials,
                    const std::vector<LoadCase>& load_cases,
                    const ElasticOptions& options);

  const ElasticBase& base() const { return base_; }

  /// Solves all load cases in processes of their own; `start`: a solution to
  /// begin from, or null (the base itself).
  ElasticSolution solve(const TetMesh& mesh,
                        const std::vector<LoadCase>& load_cases,
                        const RegionMaterials& regions,
                        const ElasticSolution* start) const;

 private:
  std::optional<Failure> bad_design(const TetMesh& mesh, const Points& x) const;
  int processes() const;
  /// What holds each group; the base's own where `mesh` is the base.
  std::optional<Failure> hold(const TetMesh& mesh,
                              const std::vector<LoadCase>& load_cases,
                              bool is_base,
                              std::vector<Holding>& holdings) const;
  /// Points into its arguments.
  std::vector<PetscGroup> grouped(const std::vector<Holding>& holdings,
                                  const std::vector<VectorX>& f,
                                  const std::vector<VectorX>& start) const;

  ElasticBase base_;
  ElementTable table_;
  std::vector<HeldCases> groups_;
};

}  // namespace meniscus
