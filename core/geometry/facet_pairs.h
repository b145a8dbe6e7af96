/// Do two facets cross, or come too near? And which pairs are worth asking.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

enum class PairState { Apart, Crossing, TooClose };

struct PairVerdict {
  PairState state = PairState::Apart;
  Vec3 position = Vec3::Zero();  // on both where they cross, else between
};

/// Facets f and g of finite, sound corners and an area above zero. Touching
/// at shared corners is fine; facets that share an edge cross when folded onto
/// each other; only facets with no common corner can be too close, at a
/// distance below `tolerance` [length].
/// Separating planes first (Gottschalk 1996), where they are further off than
/// rounding; then exact signs (orientation.h), then the distance of corners and
/// edges (Ericson 2005). With a tolerance of 0 facets without a common corner
/// are Crossing exactly where they meet, be it in one point.
PairVerdict classify_pair(const SurfaceMesh& mesh, int f, int g,
                          double tolerance);

/// Calls visit(f, g), f < g, once for every pair of `facets` whose bounding
/// boxes are within `tolerance`, in a fixed order, until visit returns false.
/// A bounding-box tree: O(n log n + pairs). Gives up, with false, after
/// comparing `most_steps` pairs of boxes.
bool for_each_near_pair(
    const SurfaceMesh& mesh, const std::vector<int>& facets, double tolerance,
    const std::function<bool(int, int)>& visit,
    std::int64_t most_steps = std::numeric_limits<std::int64_t>::max());

}  // namespace meniscus
