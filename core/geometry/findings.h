/// How check_surface words what it finds.
#pragma once

#include "core/geometry/mesh_checks.h"

namespace meniscus {

/// Fills in the surfaces' names and the message from kind, facets (at least
/// one) and position.
void describe(const SurfaceMesh& mesh, Finding& finding);

}  // namespace meniscus
