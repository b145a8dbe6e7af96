/// A film complex cut along its junctions.
#pragma once

#include <vector>

#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// Film facets of one label, joined by edges that are no junctions.
struct SheetFacets {
  std::vector<int> facets;    // of the topology, ascending
  std::vector<char> flipped;  // per facet of these: its front is the sheet's
                              // back
};

/// In order of their first facet. Throws MeshError, with place, for a film that
/// has one side only.
std::vector<SheetFacets> cut_into_sheets(const WallTopology& topology,
                                         const WallFilms& films);

}  // namespace meniscus::walls
