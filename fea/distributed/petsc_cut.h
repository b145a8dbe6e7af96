/// Cuts an elastic system into the pieces that the processes of meniscus-petsc
/// read, and puts their results together.
#pragma once

#include <filesystem>
#include <vector>

#include "fea/equations/elastic_base.h"
#include "fea/solver/assembly.h"
#include "fea/solver/conjugate_gradients.h"

namespace meniscus::distributed {

/// Load cases that are held alike, in the solver's numbering.
struct PetscGroup {
  const supports::Restraints* restraints = nullptr;
  std::vector<const VectorX*> f;      // per load case [force]
  std::vector<const VectorX*> start;  // the same, or none [length]
};

/// Not owned. Nodes must lie along a curve (curve_order), elements ascend by
/// their lowest node.
struct PetscSystem {
  const solver::ElementTable& table;
  const Points& x;
  const std::vector<element::ElasticLaw>& laws;
  std::vector<PetscGroup> groups;
  double tolerance = 1e-10;
  int max_iterations = 400;
};

/// Writes one file a process into `folder` (fea/distributed/petsc_protocol.h).
/// Memory beside: one piece. Throws IoError.
void write_pieces(const PetscSystem& system, int processes,
                  const std::filesystem::path& folder);

/// By group of the system.
struct PetscGroupSolution {
  VectorX diagonal;  // of the stiffness [force/length]
  std::vector<VectorX> u;
  std::vector<solver::CgColumn> columns;
};

struct PetscSolution {
  std::vector<PetscGroupSolution> groups;
  std::vector<double> process_memory;  // peak of each process [byte]
  double setup_seconds = 0.0;          // of the slowest process
  double solve_seconds = 0.0;
};

/// Throws SolverError when a result is missing, cut off or of another kind.
PetscSolution read_results(const PetscSystem& system, int processes,
                           const std::filesystem::path& folder);

}  // namespace meniscus::distributed
