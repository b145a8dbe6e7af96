/// Several closed bodies in one surface that was read as one, as files of parts
/// from elsewhere hold them.
#pragma once

#include "core/geometry/surface_mesh.h"

namespace meniscus {

/// Each body that the facets close gets its number, in the order of its first
/// facet, where there are several; of two facets with the same corners that
/// look at each other the second is left out, and the first is between two
/// bodies. facet_bodies of `surface` are not read. A surface that closes no
/// body, or one, stays as it is, and so does one that does not say what is
/// inside: check_surface() has words for it. O(n log n), deterministic.
SurfaceMesh with_own_bodies(SurfaceMesh surface);

}  // namespace meniscus
