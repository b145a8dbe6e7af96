/// What the mesher must know about a closed surface before it fills it.
#pragma once

#include <string>

#include "core/surface_mesh.h"

namespace meniscus {

struct SurfaceFit {
  double volume = 0.0;  // enclosed, cavities taken off [length^3]
  Points cavities;      // a point strictly inside each cavity
  std::string problem;  // why it cannot be filled; empty when it can
};

/// Components of negative volume are cavities and must lie inside a component
/// of positive volume. `surface` must be closed and oriented.
SurfaceFit fit_surface(const SurfaceMesh& surface);

}  // namespace meniscus
