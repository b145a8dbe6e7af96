/// Surfaces prepared for smooth shading.
#pragma once

#include <vector>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "core/geometry/surface_mesh.h"

namespace meniscus::render {

/// Sharper is drawn as a crease [deg].
inline constexpr double kCreaseAngle = 50.0;

/// Points are split between surfaces, so that shading is smooth inside each
/// and crisp at its rim; `source` gives the mesh's point of each.
struct ShadedSurface {
  vtkSmartPointer<vtkPolyData> data;
  std::vector<int> source;
};
ShadedSurface shade(const SurfaceMesh& mesh,
                    const std::vector<char>& use_label);

}  // namespace meniscus::render
