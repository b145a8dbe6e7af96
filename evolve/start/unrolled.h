/// A piece of an exact surface laid into a plane.
#pragma once

#include <limits>
#include <vector>

#include "core/geometry/exact_shape.h"

namespace meniscus::start {

/// Planes, cylinders and cones without a change of lengths, others nearly:
/// along each parameter by the length in the middle of the piece, spheres about
/// a pole that the piece has as cones.
class Unrolled {
 public:
  /// `around`: parameters of the piece's rim, loop by loop. Throws InvalidInput
  /// for a sphere with both of its poles.
  Unrolled(const ExactSurface& surface,
           const std::vector<std::vector<Vec2>>& around);

  Vec3 to_plane(const Vec2& place) const;  // z = 0
  Vec2 from_plane(const Vec3& at) const;

  /// The longest edge by which normals turn by a twelfth of a turn at most
  /// along the middle of the piece, either way; infinite where they do not.
  double longest_edge() const { return longest_edge_; }

 private:
  bool about_apex_ = false;  // else to scale
  Vec2 scale_ = Vec2::Ones();
  // About an apex: it is at `apex_` of the second parameter, in the direction
  // `side_`; the plane's angle is `turn_` times the first from `zero_`.
  double apex_ = 0.0;
  double side_ = 1.0;
  double turn_ = 1.0;
  double zero_ = 0.0;
  double longest_edge_ = std::numeric_limits<double>::infinity();
};

}  // namespace meniscus::start
