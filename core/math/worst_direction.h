/// The unit direction within a cone along which a linear or a quadratic form is
/// largest: of a load of given size that may come from any of them.
#pragma once

#include "core/types.h"

namespace meniscus {

/// Unit vectors d whose angle to the axis is no more than the half-angle: 0:
/// the axis alone, pi: all.
struct Cone {
  Vec3 axis = Vec3::UnitZ();  // unit
  double half_angle = 0.0;    // [rad], 0 to pi
};

struct WorstDirection {
  double value = 0.0;
  Vec3 direction = Vec3::UnitZ();  // unit, in the cone
};

/// max m . d: |m| where m lies in the cone, else |m| cos(angle beyond its rim).
/// By the envelope theorem the derivative of the value is that at the direction
/// held. It has a kink where m = 0 (all directions are equal then, and the axis
/// is told) and, beyond the rim, where m points against the axis.
WorstDirection worst_of_linear(const Vec3& m, const Cone& cone);

/// max d^T Q d, Q symmetric: its largest eigenvalue where an eigenvector of it
/// (either sign) lies in the cone, else the largest value on the rim, which is
/// a problem of two unknowns and one multiplier (J. J. More and D. C. Sorensen,
/// Computing a trust region step, SIAM J. Sci. Stat. Comput. 4, 1983).
/// Derivative as above, d d^T by Q, exact where the largest eigenvalue is
/// simple, on the rim where one place of it is the best. Elsewhere the value
/// has a kink, and the direction told is one of the best. In cones of a right
/// angle and more there is one of each pair d, -d: as in all directions.
WorstDirection worst_of_quadratic(const Mat3& Q, const Cone& cone);

}  // namespace meniscus
