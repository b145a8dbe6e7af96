/// What a case asks of walls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/place_field.h"
#include "evolve/walls/thicken.h"

namespace meniscus::walls {

/// Films made solid by thickness.
struct WallSpec {
  std::string name;
  std::vector<std::string> films;
  /// Above 0 on the films [length]. Of another design the field at its numbers
  /// and where the frozen film was: the film takes its thickness along.
  PlaceField thickness;
  WallSide side = WallSide::Both;
  /// Radius at junctions [length]; half the thickness when left out.
  std::optional<double> fillet;
  /// Planar curves in whose plane the wall ends; at others it ends square to
  /// its films.
  std::vector<std::string> flush = {};
  /// The body that the wall is part of; walls that meet are of one.
  int region = 0;
};

}  // namespace meniscus::walls
