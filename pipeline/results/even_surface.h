/// The facets of a part from a file made even: tessellations of CAD faces are
/// needles, which fill with slivers.
#pragma once

#include "core/geometry/surface_mesh.h"
#include "pipeline/results/part_shape.h"

namespace meniscus::results {

/// `part` remeshed towards edges of `edge` [length], shorter where its faces
/// bend: 0.2 of their radius there, longer with the distance from it. Points
/// stand on `shape`; lines where faces meet and sharp edges inside a face stay
/// lines, and their corners stay where they are. Labels stay.
/// Deterministic. Throws InvalidInput where memory does not hold the facets.
SurfaceMesh even_surface(const SurfaceMesh& part, double edge,
                         const PartShape& shape);

}  // namespace meniscus::results
