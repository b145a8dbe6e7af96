/// What adjoints need of a solved design (internal to ElasticModel).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fea/element/elastic_law.h"
#include "fea/equations/elastic_adjoint.h"
#include "fea/equations/pin_motions.h"
#include "fea/solver/assembly.h"
#include "fea/solver/node_order.h"
#include "fea/solver/preconditioner.h"
#include "fea/supports/restraints.h"

namespace meniscus::equations {

/// What a solve leaves for the adjoints of a group of load cases.
struct SolvedGroup {
  PinMotions pins;
  std::shared_ptr<const solver::Preconditioner>
      factor;  // the design's, or null
};

/// In the solver's numbering.
struct KeptState {
  /// Load cases that are held alike.
  struct Group {
    std::vector<int> cases;
    supports::Restraints restraints;
    SolvedGroup solved;
    const solver::Preconditioner* preconditioner = nullptr;  // of the model
  };

  // Of the model, not owned:
  const solver::ElementTable* table = nullptr;
  const solver::NodeOrder* order = nullptr;
  Monitor* monitor = nullptr;

  std::vector<element::ElasticLaw> laws;  // of the design
  double tolerance = 0.0;
  int max_iterations = 0;
  int patience = 0;  // of the preconditioners
  std::vector<Group> groups;
  std::vector<std::string> names;      // of load cases
  solver::BlockMatrix<double> matrix;  // without springs
  Points x;                            // of solver's nodes [length]
};

/// See ElasticModel::solve_adjoints().
AdjointSolution solve_adjoints(const KeptState& state,
                               const std::vector<int>& load_cases,
                               const std::vector<VectorX>& right_hand_sides);

}  // namespace meniscus::equations
