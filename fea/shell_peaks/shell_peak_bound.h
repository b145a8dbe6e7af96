/// A smooth upper bound of the largest value that a criterion takes at a
/// shell's nodes: what functionals/nodal_peak.h has of solids.
#pragma once

#include <vector>

#include "fea/functionals/nodal_peak.h"
#include "fea/shell/shell_gradient.h"
#include "fea/shell/shell_loads.h"
#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// A displacement, 6 per node, and the loads that it is the solution under, on
/// loan.
struct ShellState {
  const ShellLoads& loads;
  const VectorX& displacement;
};

struct ShellPeakInput {
  const ShellMesh& mesh;
  const std::vector<Section>& sections;
  /// Per facet: which smooth surface it is of. Facets of one, all of one
  /// section, have the mean of their stresses at a node that they share.
  const std::vector<int>& surface;
  std::vector<ShellState> states;
  double excess = 0.02;  // as NodalPeakInput has it
  element::Derivatives derivatives = element::Derivatives::All;
};

/// Derivatives with nodal displacements held, not the bubbles, which follow
/// them.
struct ShellPeakBound : ShellGradient {
  std::vector<VectorX> by_displacement;          // per state
  std::vector<ActionGradient> by_state_actions;  // the same
  /// The states' stresses where the value is largest, the first of equals.
  std::vector<element::Stress> largest;
};

/// (sum v^p)^(1/p) over the nodes of all surfaces, at both faces of each ply
/// and half way between; p as nodal_peak() takes it. The criterion's regions
/// are the plies of all sections, in order. Exact derivatives; the same bits
/// for any number of threads. Throws as shell_stress(), and InvalidInput for an
/// excess out of (0, 1).
ShellPeakBound shell_peak_bound(const ShellPeakInput& input,
                                const functionals::NodeCriterion& criterion);

}  // namespace meniscus::shell
