/// Rigid pins in the equations: how the part answers to their motions.
#pragma once

#include <vector>

#include "fea/equations/held_solver.h"

namespace meniscus::equations {

/// Of one design and all load cases that are held alike. Without pins empty.
struct PinMotions {
  /// Z: the part's displacement under the unit of each motion that is not
  /// fixed, all other motions 0, without loads; pin by pin, in their order;
  /// solver's numbering.
  std::vector<VectorX> Z;
  Eigen::MatrixXd stiffness;  // Z^T (K + S) Z
  solver::CgColumn column;    // the worst of the solutions
};

/// `x`: of the solver's nodes.
PinMotions find_pin_motions(const Points& x, HeldSolver& solver);

/// u += Z q such that pins are at rest: Z^T (f - (K + S) u) = 0. `u`: solved
/// with the pins' nodes held.
void release_pins(const PinMotions& motions, const HeldSolver& solver,
                  const VectorX& f, VectorX& u);

/// What release_pins would have made of `u`, taken off: a start with the
/// pins' nodes held for a solution near to u. `x`: as above.
void hold_pins(const PinMotions& motions,
               const supports::Restraints& restraints, const Points& x,
               VectorX& u);

/// The one that did not converge, or took longer.
solver::CgColumn worse_of(const solver::CgColumn& a, const solver::CgColumn& b);

}  // namespace meniscus::equations
