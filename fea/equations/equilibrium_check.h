/// Are the loads carried? Reactions, their balance, the true residual.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/types.h"
#include "fea/supports/restraints.h"

namespace meniscus::equations {

/// One load case, all in the solver's numbering, 3 per node.
struct EquilibriumInput {
  const Points& x;
  const VectorX& f;         // loads [force]
  const VectorX& internal;  // K u [force]
  const VectorX& springs;   // S u [force]
  const VectorX& u;         // [length]
  const supports::Restraints& restraints;
  const VectorX& diagonal;  // of the stiffness [force/length]
  bool enforced = false;    // something is held at another place than 0
};

struct Equilibrium {
  VectorX reactions;       // K u - f along held directions and on the nodes of
                           // pins, -S u along free ones [force]
  double residual = 0.0;   // |f - K u - S u| / |f| on free unknowns; what pins
                           // and enforced displacements pass on is load, too
  double rounding = 0.0;   // what double precision allows for that residual
  double imbalance = 0.0;  // |sum of reactions and loads| / sum of |loads|,
                           // forces and moments (over the part's size); those
                           // on a free pin balance by themselves
  double energy = 0.0;     // u . K u / 2 [force length]
};
Equilibrium check_equilibrium(const EquilibriumInput& input);

/// Nothing when residual and imbalance are within their bounds. `tolerance`: of
/// the solution in the energy norm.
std::optional<Failure> check_residual(const Equilibrium& equilibrium,
                                      double tolerance,
                                      const std::string& load_case);

}  // namespace meniscus::equations
