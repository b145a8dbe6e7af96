/// A stiffness matrix on its free directions together with what inverts it
/// approximately, in the solver's numbering: what eigenvalue problems need.
#pragma once

#include <vector>

#include "fea/element/material.h"
#include "fea/equations/pin_motions.h"
#include "fea/solver/assembly.h"
#include "fea/solver/node_freedom.h"
#include "fea/solver/node_order.h"
#include "fea/solver/preconditioner.h"
#include "fea/supports/pins.h"

namespace meniscus::equations {

struct ElasticOperator {
  // Of the model, not owned:
  const solver::ElementTable* table;
  const solver::NodeOrder* order;
  const solver::Preconditioner* preconditioner;

  std::vector<element::Material> materials;  // of the design
  solver::BlockMatrix<double> K;             // with springs
  solver::NodeFreedom freedom;               // pins' nodes are held
  std::vector<supports::PinFrame> pins;
  PinMotions pin_motions;  // of them
  Points x;                // of solver's nodes [length]
};

/// Vectors of 3 per node from the mesh's numbering into the solver's, and back.
VectorX to_solver(const solver::NodeOrder& order, const VectorX& v);
VectorX to_mesh(const solver::NodeOrder& order, const VectorX& v);

}  // namespace meniscus::equations
