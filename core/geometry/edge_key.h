/// The one name of an edge that is met from either end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/types.h"

namespace meniscus {

/// The edge between two points as a key: first id <= second id, whichever way
/// it is run. Sorted containers of it go by the first id, then by the second.
/// An edge in its direction is Edge{from, to} itself.
inline Edge edge_key(int a, int b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// For hashed containers of edges, keys or directed; ids not negative.
struct EdgeHash {
  std::size_t operator()(const Edge& edge) const {
    return std::hash<std::uint64_t>()(
        (static_cast<std::uint64_t>(edge[0]) << 32) |
        static_cast<std::uint32_t>(edge[1]));
  }
};

}  // namespace meniscus
