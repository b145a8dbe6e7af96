/// Cylinders and cones unrolled into a plane, and angles about their axes.
#pragma once

#include <vector>

#include "evolve/films/bent_wall.h"

namespace meniscus::films {

/// The point of space that about_axis() gives these coordinates.
Vec3 from_about_axis(const BentWall& wall, const Vec3& about);

/// Where a cylinder or cone is so far along its axis [length], at an angle
/// about it from first_axis() [rad].
Vec3 at_angle(const BentWall& wall, double angle, double z);

/// Angles about the axis along a closed loop and back to its first point [rad],
/// each by the turn from the last one, so that they may go around.
std::vector<double> angles_along(const BentWall& wall, const Points& loop);

/// A cylinder or cone laid into the plane z = 0 without a change of lengths:
/// (R t, z), or about the apex at the origin; t is the angle less `zero`.
struct WallDevelopment {
  BentWall wall;
  double zero = 0.0;  // [rad]

  Vec3 to_plane(double angle, double z) const;
  /// Of a cone for |t| sin(half angle) up to half a turn.
  Vec3 from_plane(const Vec3& q) const;
};

}  // namespace meniscus::films
