/// What pictures are drawn of, as plain arrays.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::picture {

/// A labelled surface and, for a part, what its nodes carry (else empty).
struct PictureSurface {
  SurfaceMesh mesh;
  Points displacement;            // [length]
  std::vector<double> von_mises;  // [pressure]
  std::string length_unit;        // of the displacement; may be empty
  std::string stress_unit;
};

/// Corners of tetrahedra, four- or ten-node.
struct PictureTets {
  Points nodes;
  std::vector<std::array<int, 4>> corners;
};

}  // namespace meniscus::picture
