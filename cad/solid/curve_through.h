/// Smooth curves through points.
#pragma once

#include <utility>
#include <vector>

#include "cad/solid/rim_curve.h"

namespace meniscus::solid {

/// Pieces through points, and where on them each point lies: the piece and the
/// share of its parameters.
struct PointCurve {
  std::vector<RimPiece> pieces;
  std::vector<std::pair<int, double>> at;
};

/// Splines with two continuous derivatives, closed or from the first point to
/// the last, cut where the points turn by more than `sharp` [rad]: more than a
/// twelfth of a turn, as which the smallest smooth curves are given. Straight
/// between corners next to each other and where points lie on a line. Throws
/// MeshError for a closed curve of fewer than three points.
PointCurve curve_through(const Points& points, bool closed,
                         double sharp = kSharpTurn);

/// The closed one.
RimCurve rim_through(const Points& points, double sharp = kSharpTurn);

}  // namespace meniscus::solid
