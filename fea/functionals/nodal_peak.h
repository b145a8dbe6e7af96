/// A smooth upper bound of the largest value that a criterion takes at the
/// nodes, by both readings of nodal stress.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fea/element/functional.h"
#include "fea/functionals/point_chain.h"
#include "fea/stress/exclusion_zones.h"

namespace meniscus::functionals {

/// What the stresses of one node come to, 1 where they are just allowed.
struct NodeCriterion {
  /// `stress`: one per state. `by`: as many, receive the derivatives by the six
  /// components; empty: not asked. `power`: that of the bound. Below 0 counts
  /// as 0. Asked side by side; must not throw.
  std::function<double(int region, double power,
                       std::span<const element::Stress> stress,
                       std::span<element::Stress> by)>
      value;
  /// Numbers that a value is itself the p-norm of: of three principal
  /// stresses 3.
  int terms = 1;
};

struct NodalPeakInput {
  const TetMesh& mesh;
  const std::vector<element::Material>& materials;
  std::vector<StressState> states;
  const stress::Excluded& excluded;  // as for peak_of() (peak_stress.h)
  /// The bound is at most this part above the largest value, > 0.
  double excess = 0.02;
  element::Derivatives derivatives = element::Derivatives::All;
};

/// Of several load cases on one mesh.
struct NodalPeak {
  double value = 0.0;
  Points by_nodes;
  std::vector<double> by_modulus;  // as Functional's
  struct State {
    VectorX by_displacement;
    VectorX by_temperature;
  };
  std::vector<State> states;
  /// The states' stresses at the node and reading with the largest value, the
  /// first of equals.
  std::vector<element::Stress> largest;
};

/// (sum v^p)^(1/p) over the copies of all nodes that count, each once as
/// recover_by_patches() and once as average_extrapolations() reads it. A sum,
/// not a mean: never below the largest v, and at most n^(1/p) times it for n
/// numbers; p = ln n / ln(1 + excess), at least 4, so that this is `excess`.
/// n hangs on the topology alone, so that p is the same in all designs. 0
/// where no v is above 0. Parts below 1e-14 of the largest are 0 to rounding
/// and cost nothing. Exact derivatives; the same bits for any number of
/// threads. Throws InvalidInput: as point_stress(), an excess out of (0, 1),
/// no node left, a temperature without a slope.
NodalPeak nodal_peak(const NodalPeakInput& input,
                     const NodeCriterion& criterion);

}  // namespace meniscus::functionals
