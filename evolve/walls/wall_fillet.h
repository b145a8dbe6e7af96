/// Fillets where the films of walls meet.
#pragma once

#include <functional>
#include <vector>

#include "evolve/walls/wall_offset.h"
#include "evolve/walls/wall_spec.h"
#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// Films cut along their junctions.
struct WallSheets {
  std::vector<OffsetSheet> offset;
  std::vector<int> of;        // per facet of the topology: its sheet
  std::vector<char> flipped;  // per facet: its front is its sheet's back
};

struct FilletInput {
  const WallTopology& topology;
  const WallFilms& films;
  const WallSheets& sheets;
  const std::vector<WallSpec>& walls;
  std::function<double(int, int)> asked;  // thickness of a wall at a vertex
  const std::vector<std::vector<WallMove>>& moves;  // per wall point, so far
};

/// What fillets add to the offset of every wall point [length], by the walls
/// whose thickness it follows. In the plane
/// across a junction line the sides of two neighbouring films get an arc that
/// touches both, and the line's own point is in its middle. The other points of
/// a side slide along it to make room (wall_slide.h), and what comes to lie
/// under the arc is lifted onto it, so that facets of any size beside the line
/// neither fold nor leave the side. Where lines meet or end on a rim, their
/// points slide along them as well. A fillet is no larger than its films have
/// room for. Sectors of 180 degrees and more have none; where one of their
/// sides is cut short by a thicker neighbour it slides as well.
std::vector<std::vector<WallMove>> fillet_moves(const FilletInput& input);

}  // namespace meniscus::walls
