/// Compromises between objectives: which designs no other beats, and the
/// sequence of problems that finds them.
#pragma once

#include <vector>

#include "optimize/minimize.h"

namespace meniscus::optimize {

/// The indices, ascending, of the points that no other point is at least as
/// good as in every objective and better in one; all are minimised. Of equal
/// points the first stays. Throws InvalidInput for unequal sizes or NaN.
std::vector<int> pareto_front(const std::vector<VectorX>& points);

/// `count` >= 1 bounds for the second objective strictly between the `best`
/// value it can have and the one, `worst`, that it has where the first
/// objective is least; from worst to best, so that each problem starts from
/// its neighbour's answer (Y. Haimes et al., IEEE Trans. SMC 1, 1971).
VectorX epsilon_levels(double best, double worst, int count);

/// `problem` with constraint `index` bounded above by `level` as well.
MinimizeProblem with_upper_bound(const MinimizeProblem& problem, int index,
                                 double level);

/// `problem` with the objective and constraint `index` exchanged, the old
/// objective unbounded: its minimum is the other end of the front.
MinimizeProblem exchanged(const MinimizeProblem& problem, int index);

}  // namespace meniscus::optimize
