/// A stiffness matrix on its free directions together with what inverts it
/// approximately, in the solver's numbering: what eigenvalue problems need.
#pragma once

#include <vector>

#include "fea/element/material.h"
#include "fea/solver/assembly.h"
#include "fea/solver/node_freedom.h"
#include "fea/solver/node_order.h"
#include "fea/solver/preconditioner.h"

namespace meniscus {

struct ElasticOperator {
  // Of the model, not owned:
  const ElementTable* table;
  const NodeOrder* order;
  const Preconditioner* preconditioner;

  std::vector<Material> materials;  // of the design
  BlockMatrix<double> K;            // with springs
  NodeFreedom freedom;
  Points x;  // of solver's nodes [length]
};

/// Vectors of 3 per node from the mesh's numbering into the solver's, and back.
VectorX to_solver(const NodeOrder& order, const VectorX& v);
VectorX to_mesh(const NodeOrder& order, const VectorX& v);

}  // namespace meniscus
