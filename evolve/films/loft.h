/// The band between two closed curves.
#pragma once

#include <vector>

#include "core/types.h"

namespace meniscus::films {

/// Facets between closed polygons `low` (ids 0 ...) and `high` (ids continue
/// after low's), whose counts of points may differ. Both may run either way;
/// start and direction are matched so that the band is twisted least. Facets
/// run along `low` in its direction.
std::vector<Triangle> loft_band(const Points& low, const Points& high);

}  // namespace meniscus::films
