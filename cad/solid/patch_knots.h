/// Knots of patches: enough for the film's edges and its rims' bends.
#pragma once

#include <vector>

#include "cad/solid/rim_edges.h"

namespace meniscus::solid {

/// A side that the knots along it must serve.
struct SideDemand {
  double length = 0.0;            // of the side [length]
  const RimEdges* rim = nullptr;  // null: no rim
  double from = 0.0;              // places on the rim
  double to = 0.0;
  bool growing = true;
};

/// Knots over [0, 1] common to all the sides: doubled where smooth pieces of a
/// rim meet, threefold at its corners; spans no longer than `span` [length].
std::vector<double> common_knots(const std::vector<SideDemand>& sides,
                                 double span);

}  // namespace meniscus::solid
