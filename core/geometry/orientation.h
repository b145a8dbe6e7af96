/// On which side? Signs of determinants of points, exact for all finite
/// coordinates: the numbers are doubles, the answers are theirs, not their
/// roundings'.
#pragma once

#include "core/types.h"

namespace meniscus {

/// Sign of (b - a) x (c - a) . (d - a): 1 where a, b, c turn anticlockwise seen
/// from d, -1, or 0 exactly where the four lie in one plane. Double precision
/// behind a bound of its rounding error (Shewchuk, Adaptive precision
/// floating-point arithmetic, 1997), else whole numbers of any length.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The same in a plane: a, b, c seen along axis `along` (0, 1, 2), from its
/// positive end. 0 exactly where they are in line.
int orientation_along(int along, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace meniscus
