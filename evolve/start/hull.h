/// Convex hull of points, triangulated (qhull behind one door).
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::start {

/// Facets of the hull, outward, every corner in `points`, lowest id first and
/// sorted, so that qhull's own order does not matter. Points inside flat faces
/// or straight edges need not appear. Throws MeshError with qhull's own words
/// when there is no solid hull (fewer than four points, all in one plane).
std::vector<Triangle> convex_hull(const Points& points);

}  // namespace meniscus::start
