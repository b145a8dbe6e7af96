/// A curve as the lines and arcs that CAD files know.
#pragma once

#include <vector>

#include "cad/solid/rim_curve.h"
#include "evolve/curves/curve.h"

namespace meniscus::step_parts {

/// End to end, all around. None for shapes of other curves: there a spline goes
/// through the film's own points.
std::vector<solid::RimPiece> rim_pieces(const curves::CurveShape& shape);

}  // namespace meniscus::step_parts
