/// Ends of walls in planes: those on which their films slide, and those of
/// curves at which they are flush.
///
/// A point of a wall over a film vertex of such a plane stays in it, and as far
/// from the film's tangent plane as the wall's offset says: of an offset w off
/// a film of unit normal n, with P onto the directions that the planes leave,
///
///   d = P w + P n ((I - P) n . w) / |P n|^2,   hence n . d = n . w.
///
/// Where film and plane meet at an angle a the end is so t / sin a wide.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::walls {

struct WallPlane {
  Vec3 normal = Vec3::UnitZ();  // unit, either way
  std::string rim;              // of walls that end in it: "FILM/" and this
};

/// Planes, and of each point of a film those that it stays in.
struct WallPlanes {
  std::vector<WallPlane> planes;
  std::vector<std::vector<int>> at;  // per point; empty: no planes at all

  /// The projector onto the directions that a point's planes leave it; none for
  /// a point that stays in no plane.
  std::optional<Mat3> along(int point) const;
  /// A plane that both points stay in; -1: none.
  int common(int a, int b) const;
};

/// d of the offset w: see above. P n must not be 0.
Vec3 in_planes(const Mat3& along, const Vec3& normal, const Vec3& w);

/// What d depends on, transposed: dJ/dw and dJ/dn (n as if free) from dJ/dd.
struct InPlanesGradient {
  Vec3 w = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
};
InPlanesGradient transpose_in_planes(const Mat3& along, const Vec3& normal,
                                     const Vec3& w, const Vec3& by);

}  // namespace meniscus::walls
