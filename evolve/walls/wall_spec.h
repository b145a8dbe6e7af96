/// What a case asks of walls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/expression.h"
#include "evolve/walls/thicken.h"

namespace meniscus::walls {

/// Films made solid by thickness.
struct WallSpec {
  std::string name;
  std::vector<std::string> films;
  Expression thickness;  // over x, y, z; above 0 on the films [length]
  WallSide side = WallSide::Both;
  /// Radius at junctions [length]; half the thickness when left out.
  std::optional<double> fillet;
  /// The thickness where it is the same everywhere: it may follow the design
  /// [length]. Of rates: its derivative.
  std::optional<double> number;
  /// The body that the wall is part of; walls that meet are of one.
  int region = 0;
};

}  // namespace meniscus::walls
