/// Shapes as they are painted: triangles with normals and colours at points.
#pragma once

#include <array>
#include <vector>

#include "core/types.h"
#include "report/render/colour_map.h"
#include "report/render/eye_view.h"
#include "report/render/lighting.h"

class vtkPolyData;

namespace meniscus::render {

using Paint = std::array<double, 4>;  // red, green, blue, opacity, 0..1

struct SurfaceStyle {
  Colour colour = {0.8, 0.8, 0.8};
  double opacity = 1.0;
  Finish finish = {};
  bool flat = false;        // a normal for each facet
  bool only_front = false;  // facets that face the eye: of a closed surface
                            // no others are seen
  bool edges = false;       // thin lines along facets
  Colour edge_colour = {0.2, 0.25, 0.3};
  double edge_width = 1.0;  // [pixel]
};

struct PaintedShape {
  Points points;
  Points normals;             // one per point, unit
  std::vector<Paint> paints;  // one per point
  std::vector<Triangle> triangles;
  SurfaceStyle style;
};

/// Polygons and strips of `data`; its normals, or smooth ones with creases
/// where it has none. `paints`: one per point of `data` (which then must have
/// normals), or none: the style's.
PaintedShape painted(vtkPolyData* data, const SurfaceStyle& style,
                     const std::vector<Paint>& paints = {});

/// Triangles ready to be drawn in order, each with the light on it: opaque
/// ones, then translucent ones from the farthest to the nearest.
struct PaintedScene {
  Points points;
  std::vector<std::array<unsigned char, 4>> colours;  // one per point
  std::vector<Triangle> triangles;
};

/// Refines what is coarser than a few pixels.
PaintedScene paint(std::vector<PaintedShape> shapes, const EyeView& view);

}  // namespace meniscus::render
