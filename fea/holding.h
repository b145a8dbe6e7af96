/// What holds a model in one load case: supports and springs, as the solver
/// sees them.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/load_case.h"
#include "fea/node_freedom.h"
#include "fea/node_order.h"
#include "fea/springs.h"

namespace meniscus {

/// In the solver's numbering.
struct Holding {
  std::vector<char> fixed;  // along the axes, 3 per node; nodes in no element
  NodeFreedom oblique;      // nodes held along other directions
  SpringBlocks springs;

  /// The stiffness itself serves.
  bool plain() const { return oblique.held.empty() && springs.at.empty(); }
  bool operator==(const Holding& other) const;
};

/// Throws InvalidInput (see supports.h, springs.h; nothing held) and
/// SolverError when the body can move.
void check_holding(const TetMesh& mesh, const LoadCase& load_case);

/// Throws InvalidInput as check_holding does.
Holding make_holding(const TetMesh& mesh, const LoadCase& load_case,
                     const NodeOrder& order);

/// The same nodes are held along as many directions, though these may turn.
bool alike(const Holding& a, const Holding& b);

int free_unknowns(const Holding& holding);

/// The stiffness with springs, free of what is held obliquely (constrain.h).
BlockMatrix<double> held_matrix(const BlockPattern& pattern,
                                const BlockMatrix<double>& matrix,
                                const Holding& holding);

/// Of the corner nodes; `corner`: their number among all, ascending.
NodeFreedom corner_freedom(const NodeFreedom& fine,
                           const std::vector<int>& corner);

}  // namespace meniscus
