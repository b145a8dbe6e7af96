/// Orthonormal axes from two directions.
#pragma once

#include "core/types.h"

namespace meniscus::element {

/// A local frame: `first`, the part of `second` across it, and their cross
/// product.
struct LocalAxes {
  Vec3 first = Vec3::UnitX();   // any length but 0
  Vec3 second = Vec3::UnitY();  // not parallel to `first`

  bool operator==(const LocalAxes&) const = default;
};

/// Both have a length and span a plane.
bool span_a_plane(const LocalAxes& axes);

/// The frame's unit vectors as columns, right-handed; span_a_plane must hold.
Mat3 unit_axes(const LocalAxes& axes);

}  // namespace meniscus::element
