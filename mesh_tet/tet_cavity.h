/// A cavity around a new node.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mesh_tet/tet_editor.h"

namespace meniscus::mesh_tet {

struct Cavity {
  std::vector<int> elements;
  std::vector<std::array<int, 3>> faces;  // counter-clockwise from outside
  double merit = 0.0;                     // the least of the new elements
};

/// Where a node might help: the centroids of the neighbours, and some depths
/// below the faces that lie on the surface.
std::vector<Vec3> places_beside(const TetEditor& tets, int e);

/// The least connected set of elements, with those of `seeds` in it, whose
/// boundary faces all make elements of a merit above `floor` with `place`
/// (Klingner and Shewchuk 2007, greedily). Nothing where the surface is in the
/// way, a node would be lost, or the set exceeds `most`.
std::optional<Cavity> grow_cavity(const TetEditor& tets,
                                  std::span<const int> seeds, const Vec3& place,
                                  double floor, std::size_t most = 40);

}  // namespace meniscus::mesh_tet
