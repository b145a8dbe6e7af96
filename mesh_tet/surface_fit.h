/// What the mesher must know about a closed surface before it fills it.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::mesh_tet {

struct SurfaceFit {
  std::vector<double> volumes;  // per body, cavities taken off [length^3]
  double volume = 0.0;          // of all bodies [length^3]
  Points cavities;              // a point strictly inside each cavity
  std::string problem;          // why it cannot be filled; empty when it can
};

/// `surface` must have no finding of check_surface. O(n log n).
SurfaceFit fit_surface(const SurfaceMesh& surface);

}  // namespace meniscus::mesh_tet
