/// Sheets that end in planes on which they slide.
#pragma once

#include <optional>
#include <vector>

#include "evolve/walls/jet_fit.h"
#include "evolve/walls/sheet.h"
#include "evolve/walls/wall_planes.h"

namespace meniscus::walls {

/// Both lists per vertex of a sheet; empty: it slides nowhere.
struct SheetEnds {
  /// The projector onto the directions that its planes leave a vertex.
  std::vector<std::optional<Mat3>> along;
  Points normals;  // unit, of its jets

  bool slides(int vertex) const {
    return !along.empty() && along[vertex].has_value();
  }
};

SheetEnds ends_of(const Sheet& sheet, const std::vector<Jet>& jets,
                  const WallPlanes& planes);

/// An end of a wall leaves its film's point along the film where plane and film
/// do not meet at right angles, t / (2 tan a) on either side. The `side` of
/// offset points beside it shifts with it along the film, less and less over
/// three times that way: else those nearer than it would lie beyond the plane.
void make_room(const Sheet& sheet, const SheetEnds& ends, Points& side);

}  // namespace meniscus::walls
