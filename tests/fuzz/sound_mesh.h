/// What readers of surfaces promise.
#pragma once

#include <cstdlib>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

/// Ends the process where a facet names no point or no label, or a point is not
/// finite.
inline void require_sound(const SurfaceMesh& mesh) {
  const auto below = [](int k, std::size_t count) {
    return k >= 0 && static_cast<std::size_t>(k) < count;
  };
  bool sound = mesh.facet_label.size() == mesh.facets.size();
  for (const Vec3& p : mesh.points) {
    sound = sound && p.allFinite();
  }
  for (std::size_t f = 0; f < mesh.facets.size() && sound; ++f) {
    for (const int v : mesh.facets[f]) {
      sound = sound && below(v, mesh.points.size());
    }
    sound = sound && below(mesh.facet_label[f], mesh.labels.size());
  }
  if (!sound) {
    std::abort();
  }
}

}  // namespace meniscus
