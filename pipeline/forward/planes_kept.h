/// Do settled films stay on the drawn side of the planes of symmetry?
#pragma once

#include <optional>

#include "core/error.h"
#include "core/geometry/surface_mesh.h"
#include "pipeline/case_data/case.h"

namespace meniscus::forward {

/// SurfaceInvalid, with the surface, the place and how far [length] it is
/// beyond, where a surface passes a plane and overlaps its image: curves alone
/// are checked before. `films`: all facets of a film model, void bodies' too.
std::optional<Failure> beyond_planes(const case_data::Case& input,
                                     const SurfaceMesh& films);

}  // namespace meniscus::forward
