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
};

/// What fillets add to the offset of every wall point [length]. In the plane
/// across a junction line the sides of two neighbouring films get an arc that
/// touches both, and the line's own point is in its middle. The other points of
/// a side slide along it to make room (wall_slide.h), and what comes to lie
/// under the arc is lifted onto it, so that facets of any size beside the line
/// neither fold nor leave the side. Sectors of 180 degrees and more have no
/// fillet; where one of their sides is cut short by a thicker neighbour it
/// slides as well.
Points fillet_moves(const FilletInput& input);

}  // namespace meniscus::walls
