/// A smooth lower bound of the least of several eigenvalues: as they cross it
/// keeps its derivatives, which the least of them does not.
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::modes {

/// F of sum g(value_k / F) = 1 with g(t) = ((1 + w - t) / w)^3 below 1 + w and
/// 0 beyond, w the width: as smooth as g (two continuous derivatives),
/// symmetric in the values, in proportion to them. Only those below reach = (1
/// + w) F count, so that the set need not be chosen. F is the least value where
/// no other is below (1 + w) times it, w / (1 + w) of it below it at most; of r
/// equal values v it is v / (1 + w - w r^(-1/3)).
struct EigenvalueBound {
  double value = 0.0;
  double reach = 0.0;
  VectorX by_value;  // dF/dvalue_k; value = sum by_value_k value_k
};

/// `values`: ascending, above 0; complete up to the reach, which is the
/// caller's to see to. Throws InvalidInput without values and for a width that
/// is not above 0.
EigenvalueBound eigenvalue_bound(const std::vector<double>& values,
                                 double width);

}  // namespace meniscus::modes
