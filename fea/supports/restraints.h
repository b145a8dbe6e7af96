/// What holds a model in one load case: supports and springs, as the solver
/// sees them.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/loads/load_case.h"
#include "fea/solver/corner_mesh.h"
#include "fea/solver/node_freedom.h"
#include "fea/solver/node_order.h"
#include "fea/supports/pins.h"
#include "fea/supports/springs.h"

namespace meniscus::supports {

/// In the solver's numbering.
struct Restraints {
  /// Nodes of pins are held, too, for these move on their own; so are nodes in
  /// no element.
  solver::NodeFreedom freedom;
  SpringBlocks springs;
  std::vector<PinFrame> pins;

  bool operator==(const Restraints& other) const;
};

/// Throws InvalidInput (see supports.h, springs.h; nothing held) and
/// SolverError when the body can move.
void check_restraints(const TetMesh& mesh, const loads::LoadCase& load_case);

/// Throws InvalidInput as check_restraints does.
Restraints make_restraints(const TetMesh& mesh,
                           const loads::LoadCase& load_case,
                           const solver::NodeOrder& order);

/// The same nodes are held along as many directions, though these may turn, and
/// the same motions of the same pins are fixed.
bool alike(const Restraints& a, const Restraints& b);

int free_unknowns(const Restraints& restraints);

/// The springs of `load_case` on the corner mesh of `map`.
SpringBlocks corner_springs(const TetMesh& mesh,
                            const loads::LoadCase& load_case,
                            const solver::NodeOrder& order,
                            const solver::CornerMap& map);

/// The stiffness with springs.
solver::BlockMatrix<double> sprung_matrix(
    const solver::BlockPattern& pattern,
    const solver::BlockMatrix<double>& matrix, const SpringBlocks& springs);

}  // namespace meniscus::supports
