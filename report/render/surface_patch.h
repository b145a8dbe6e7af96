/// One named surface of a part as loads and supports see it.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::render {

struct SurfacePatch {
  std::vector<int> facets;      // of the mesh; none: no such surface
  Vec3 centre = Vec3::Zero();   // of its area [length]
  Vec3 normal = Vec3::UnitZ();  // unit mean, out of the part
  double flatness = 0.0;        // length of the mean unit normal: 1 of a plane,
                                // 0 of a surface that closes around an axis
  Vec3 axis = Vec3::UnitZ();    // that its normals stand across, unit
  double reach = 0.0;           // half its length along that axis [length]
  double radius = 0.0;          // mean distance from its centre [length]

  bool found() const { return !facets.empty(); }
  /// A bore or a pin, not a pad.
  bool is_round() const { return flatness < 0.5; }
};

Vec3 facet_middle(const SurfaceMesh& mesh, int facet);

SurfacePatch surface_patch(const SurfaceMesh& mesh, const std::string& name);

/// Where a force is drawn to act, and the direction out of the part there: the
/// middle of a pad; of a bore the middle of the mouth that is nearer the eye.
struct Anchor {
  Vec3 at;
  Vec3 out;
};
Anchor anchor_of(const SurfacePatch& patch, const Vec3& to_eye);

/// Distances along a ray at which it crosses the surface, ascending, above 0.
std::vector<double> crossings(const SurfaceMesh& mesh, const Vec3& from,
                              const Vec3& along);

/// Tail and tip of a straight arrow of that length which acts at the anchor
/// and lies outside the part: it ends there where it presses, begins there
/// where it pulls; where the part is in the way, it begins beyond the part.
struct ArrowPlace {
  Vec3 tail;
  Vec3 tip;
};
ArrowPlace place_arrow(const SurfaceMesh& mesh, const Anchor& anchor,
                       const Vec3& along, double length, double gap);

/// The same for a place off the surface, as the middle of a pin between two
/// lugs: it begins there, or ends there where the part is in the way, or as far
/// along its line as it must to be seen.
ArrowPlace place_free_arrow(const SurfaceMesh& mesh, const Vec3& at,
                            const Vec3& along, const Vec3& to_eye,
                            double length, double gap);

/// Facets of a patch with about `spacing` between their middles, `most` at
/// most.
std::vector<int> spread_facets(const SurfaceMesh& mesh,
                               const SurfacePatch& patch, double spacing,
                               std::size_t most);

}  // namespace meniscus::render
