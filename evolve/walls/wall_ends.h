/// Sheets that meet planes aslant.
#pragma once

#include <vector>

#include "evolve/walls/jet_fit.h"
#include "evolve/walls/sheet.h"
#include "evolve/walls/wall_offset.h"

namespace meniscus::walls {

/// An end of a wall leaves its film's point along the film where plane and film
/// do not meet at right angles, t / (2 tan a) on either side. The offset points
/// beside it shift with it along the film, less and less over three times that
/// way: else those nearer than it would lie beyond the plane.
void make_room(const Sheet& sheet, const std::vector<Jet>& jets,
               const SheetEnds& ends, OffsetSides& sides);

}  // namespace meniscus::walls
