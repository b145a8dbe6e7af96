/// Walls that films slide on: a plane, or a cylinder, sphere or cone.
#pragma once

#include <array>
#include <optional>

#include "core/math/expression.h"
#include "core/types.h"

namespace meniscus::films {

enum class WallKind { Plane, Cylinder, Sphere, Cone };

/// A wall that is no plane. Cylinders and cones are around their axis.
struct BentWall {
  WallKind kind = WallKind::Cylinder;
  Vec3 at = Vec3::Zero();  // a point of the axis, the center, the apex [length]
  Vec3 axis = Vec3::UnitZ();  // unit length; of a cone from its apex into it
  double radius = 1.0;        // of cylinder and sphere [length]
  double half_angle = 0.5;    // of a cone, between its axis and its lines [rad]
};

/// The same wall; a cylinder's `at` is the point of its axis beside `place`, as
/// one far along it costs digits.
BentWall with_origin_beside(BentWall wall, const Vec3& place);

/// The same surface, wherever along its axis a cylinder has its `at`?
bool is_same(const BentWall& a, const BentWall& b);

/// 0 on the wall, of unit slope there, above 0 outside [length]; over x, y, z.
Expression wall_formula(const BentWall& wall);

/// The distance from the wall, above 0 outside [length].
double distance_outside(const BentWall& wall, const Vec3& place);

/// The nearest point of the wall; not finite on the axis or at the center, and
/// for a place whose foot on a cone's line lies beyond the apex.
Vec3 onto_wall(const BentWall& wall, const Vec3& place);

/// The same and its derivatives by the place.
struct OntoWall {
  Vec3 point = Vec3::Zero();
  Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();  // dx_i / dy_j
  std::array<Eigen::Matrix3d, 3> bend;                  // of each coordinate

  /// How fast slope x way changes with the place.
  Eigen::Matrix3d bend_along(const Vec3& way) const;
};
OntoWall onto_wall_jet(const BentWall& wall, const Vec3& place);

/// How fast way . (bend x way) of each coordinate changes with the place: by
/// differences of fourth order, good to nine figures.
Eigen::Matrix3d bend_slope(const BentWall& wall, const Vec3& place,
                           const Vec3& way);

/// Coordinates about the axis: z along it from `at`, the other two across it
/// along first_axis(wall) and axis x first_axis [length].
Vec3 first_axis(const BentWall& wall);
Vec3 about_axis(const BentWall& wall, const Vec3& place);

}  // namespace meniscus::films
