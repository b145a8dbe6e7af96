/// Internal to film_faces: a side of a patch that lies on a rim.
#pragma once

#include <vector>

#include "cad/solid/patch_knots.h"
#include "cad/solid/rim_edges.h"

namespace meniscus::solid {

/// From one place of the rim to another.
struct RimSide {
  const RimEdges* rim = nullptr;
  double from = 0.0;
  double to = 0.0;
  bool growing = true;
};

/// What it asks of the knots along it, run backwards where asked.
SideDemand demand(const RimSide& side, bool backwards);

/// The curve between the rim's vertices that fits it best on these knots.
SplineCurve fit_rim(const RimSide& side, const std::vector<double>& knots,
                    const Brep& brep);

}  // namespace meniscus::solid
