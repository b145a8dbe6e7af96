/// The arc between two sides that meet on a line.
#pragma once

#include <array>
#include <utility>

#include "core/types.h"

namespace meniscus::walls {

/// One side of a film at a line.
struct LineSide {
  Vec3 normal = Vec3::Zero();  // out of the side; any length
  Vec3 inward = Vec3::Zero();  // from the line into the film; any length
  double offset = 0.0;         // of the side from the film [length]
  double fillet = 0.0;         // [length]
  int wall = 0;
  int fillet_wall = 0;  // whose thickness the fillet follows
};

/// In the plane across the line, seen from the own side; lengths from the line.
struct FilletArc {
  Vec3 normal = Vec3::Zero();  // of the own side, unit
  Vec3 inward = Vec3::Zero();  // into the own film, unit
  Vec3 center = Vec3::Zero();
  double offset = 0.0;  // of the own side
  double radius = 0.0;  // 0: none
  double angle = 0.0;   // half of the arc's
  double begins = 0.0;  // where it touches the own side
  // The line's wall point over the own side, where the side of a thicker film
  // is in front of it: from there the own side comes down on a ramp of 45
  // degrees.
  double excess = 0.0;
  // By wall, what makes the slide.
  std::array<std::pair<int, double>, 3> parts = {};
  int lift_wall = 0;  // that lift() follows

  double length() const { return radius * angle; }
  /// How far points at the line slide to be in the middle of the arc.
  double slide() const;
  /// From where on the side is as it was.
  double ends() const;
  /// From the own side to the arc or ramp, where that runs at `way` from the
  /// line.
  Vec3 lift(double way) const;
};

/// `along`: the line, of any length.
FilletArc fillet_arc(const Vec3& along, const LineSide& own,
                     const LineSide& other);

}  // namespace meniscus::walls
