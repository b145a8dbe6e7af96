/// The named faces of a part from another program, told so that one finds them.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::results {

enum class FaceKind { Plane, Cylinder, Sphere, Other };

/// What a surface looks like, from its facets alone.
struct FaceShape {
  FaceKind kind = FaceKind::Other;
  Vec3 place = Vec3::Zero();      // middle of its area; of a cylinder on its
                                  // axis, of a sphere its centre [length]
  Vec3 direction = Vec3::Zero();  // unit: a plane's outward normal, a
                                  // cylinder's axis; else zero
  double radius = 0.0;            // of cylinder and sphere [length]
  bool hollow = false;            // of these: material is outside, as of a bore
  double area = 0.0;              // [length^2]
};

/// Of the facets of one label; facets follow curved faces to a few per cent,
/// and so do the figures.
FaceShape face_shape(const SurfaceMesh& mesh, int label);

/// A line for each name, largest first, at most `most` and how many more:
/// "  face_7: bore of radius 4 at (10, 0, 5) along (0, 0, 1), area 251 mm2".
std::string face_list(const SurfaceMesh& mesh, const std::string& length_unit,
                      std::size_t most = 40);

}  // namespace meniscus::results
