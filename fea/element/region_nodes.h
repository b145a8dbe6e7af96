/// Nodes counted once per region (material) that they belong to, so that a
/// field may jump where materials meet.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/tet_mesh.h"

namespace meniscus::element {

/// Copy 0..n-1 of a mesh's n nodes belong to the lowest region there; further
/// copies of nodes on interfaces follow.
struct RegionNodes {
  int nodes_per_element = 4;
  std::vector<int> elements;  // copies, in TetMesh's order of an element
  std::vector<int> node;      // the mesh's node of each copy

  int count() const { return static_cast<int>(node.size()); }
  std::span<const int> element(int e) const {
    return {elements.data() + static_cast<std::size_t>(e) * nodes_per_element,
            static_cast<std::size_t>(nodes_per_element)};
  }
};

RegionNodes region_nodes(const TetMesh& mesh);

/// One char per copy: 1 for corners whose elements of the region surround them
/// on all sides, 0 for corners on its boundary and for mid-sides. Told by the
/// edges opposite the corner: each is passed once in either direction just
/// when the elements close around it.
std::vector<char> surrounded_corners(const RegionNodes& nodes);

}  // namespace meniscus::element
