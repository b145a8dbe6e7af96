/// Films and caps as one triangle complex, before it is frozen into a model:
/// what start, grooming, refinement and equilibrium hand to each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/surface_mesh.h"
#include "evolve/film_system.h"

namespace meniscus {

enum class VertexKind {
  Free,     // moves with its film
  OnCurve,  // held at point_at(curves[curve], t)
  InCap     // inside a solid cap: a fixed linear map of the cap's rim
};

struct ComplexVertex {
  VertexKind kind = VertexKind::Free;
  int curve = -1;  // OnCurve: index into curves
  double t = 0.0;  // OnCurve: curve parameter in [0, 1)
};

struct ComplexSurface {
  std::string name;
  bool liquid = true;    // false: solid cap
  double tension = 0.0;  // [force/length]; 0 on caps
};

/// One surface's part in a body: sign +1 where the surface's facet normals
/// point out of the body, -1 where they point in.
struct BodySide {
  int surface = 0;
  int sign = 1;
};

struct ComplexBody {
  std::string name;
  std::vector<BodySide> sides;
  std::optional<double> volume;    // [length^3]
  std::optional<double> pressure;  // [force/length^2]
};

struct FilmComplex {
  SurfaceMesh mesh;                      // labels = surface names
  std::vector<ComplexVertex> vertices;   // one per point
  std::vector<ComplexSurface> surfaces;  // one per label
  std::vector<ComplexBody> bodies;
  std::vector<Curve> curves;
};

}  // namespace meniscus
