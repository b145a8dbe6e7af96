/// Points of exact curves and surfaces, and the places next to points.
#pragma once

#include <vector>

#include "core/geometry/exact_shape.h"

namespace meniscus {

Vec3 point_on(const ExactCurve& curve, double t);

/// The parameter in [first, last] of the edge's point nearest to `at`.
double nearest_on(const ExactEdge& edge, const Vec3& at);

/// Parameters of `pieces` + 1 points at equal shares of the edge's length, ends
/// included.
std::vector<double> equal_pieces(const ExactEdge& edge, int pieces);

double length_of(const ExactEdge& edge);

Vec3 point_on(const ExactSurface& surface, const Vec2& place);

/// Parameters of the surface's point nearest to `at`; angles within half a turn
/// of those of `near`. Splines are searched from `near`, all over where that
/// does not lead to a foot.
Vec2 place_on(const ExactSurface& surface, const Vec3& at, const Vec2& near);

/// Anywhere on it: for what has no place near.
Vec2 place_on(const ExactSurface& surface, const Vec3& at);

/// What tells where the shape is when it moves as a rigid one: its middle, and
/// points about half its size away at right angles. Their directions are askew,
/// so that no side of a face lies between two of them.
Points frame_points(const ExactShape& shape);

}  // namespace meniscus
