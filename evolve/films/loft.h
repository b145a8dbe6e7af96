/// The band between two closed curves.
#pragma once

#include <optional>
#include <vector>

#include "core/types.h"

namespace meniscus::films {

/// Facets between closed polygons `low` (ids 0 ...) and `high` (ids continue
/// after low's), whose counts of points may differ. Both may run either way;
/// start and direction are matched so that the band is twisted least, but for
/// the direction where `same_way` says whether both turn the same way. Facets
/// run along `low` in its direction.
std::vector<Triangle> loft_band(const Points& low, const Points& high,
                                std::optional<bool> same_way = std::nullopt);

}  // namespace meniscus::films
