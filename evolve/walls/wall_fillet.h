/// Fillets where the films of walls meet.
#pragma once

#include <functional>
#include <vector>

#include "evolve/walls/wall_spec.h"
#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// Films cut along their junctions.
struct WallSheets {
  int count = 0;
  std::vector<int> of;        // per facet of the topology: its sheet
  std::vector<char> flipped;  // per facet: its front is its sheet's back
};

struct FilletInput {
  const WallTopology& topology;
  const WallFilms& films;
  const WallSheets& sheets;
  const std::vector<WallSpec>& walls;
  std::function<double(int, int)> asked;  // thickness of a wall at a vertex
};

/// What fillets add to the offset of every wall point [length]. In the plane
/// across a junction line the sides of two neighbouring films, each offset by
/// half its thickness, get an arc that touches both. The film's points between
/// the line and twice the distance at which the arc begins are spread evenly
/// over arc and side, so that facets of any size beside the line neither fold
/// nor leave the side. Of several lines near a point the nearest counts most
/// (weights 1 / distance^4). Sectors of 180 degrees and more have no fillet.
Points fillet_moves(const FilletInput& input);

}  // namespace meniscus::walls
