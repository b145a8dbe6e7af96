/// Where the points of walls are on the film that they are frozen on.
#pragma once

#include <vector>

#include "evolve/walls/thicken.h"
#include "evolve/walls/wall_offset.h"
#include "evolve/walls/wall_spec.h"
#include "evolve/walls/wall_topology.h"

namespace meniscus::walls {

/// What a wall asks for at a place [length]. Throws InvalidInput, naming wall
/// and place, where that is not above 0.
double thickness_at(const WallSpec& wall, Numbers numbers, const Vec3& at);

/// Where safe thicknesses are looked for.
enum class SafePlaces { Worst, Everywhere };

struct WallReference {
  std::vector<std::vector<WallMove>> moves;  // per wall point; blends: none
  /// Per region; measured on sheets, before they are joined.
  std::vector<MeasuredThickness> thinnest;
  std::vector<MeasuredThickness> thickest;
  std::vector<SafeThickness> safe;
  std::vector<int> corrections;
  std::vector<double> safe_at;  // per film vertex, see WallModel::safe();
                                // empty unless Everywhere
};

/// Films are cut along their junctions into sheets, and those offset as
/// thicken() does. On a junction line or point each sector's point is where
/// no offset plane of its films is behind (offset_corner), which joins the
/// sheets' sides without a gap. Throws InvalidInput for a
/// thickness that is not above 0 everywhere; MeshError as make_sheet(), and for
/// a film with one side only.
WallReference wall_reference(const WallTopology& topology,
                             const WallFilms& films,
                             const std::vector<WallSpec>& walls,
                             SafePlaces places = SafePlaces::Worst);

}  // namespace meniscus::walls
