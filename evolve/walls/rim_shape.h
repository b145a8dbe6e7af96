/// Shapes of a wall's thickness on its films' own coordinates.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/math/place_shape.h"
#include "evolve/walls/wall_spec.h"

namespace meniscus::walls {

/// Splines over harmonic coordinates of a wall's films: u is 0 on the curve
/// `first` and 1 on `second`, and no flux of it leaves elsewhere; the angle
/// gains 1 around the tube between them, the way of `first` and from where that
/// is towards `zero`, seen from its middle; without, from its t = 0. `along`
/// coefficients stand evenly from u = 0 to 1, `around` of them, the last
/// running fastest, evenly about the tube, which is one film then.
struct RimSplines {
  std::string first;
  std::string second;
  int along = 1;
  int around = 1;
  std::optional<Vec3> zero = std::nullopt;  // direction, of any length
};

/// Has no values of itself: on_films() gives it these. Throws InvalidInput for
/// counts below 1, for a curve to itself and for a zero without length.
std::shared_ptr<const PlaceShape> rim_splines(const RimSplines& splines);

/// What `shape` stands between; null for a shape of space.
const RimSplines* rim_splines_of(const PlaceShape& shape);

/// `walls` with values of such shapes at the points of their facets, the
/// gradient there left 0. `mesh`: facets of walls, `wall` that of each label.
/// By exact cotangent weights (harmonic.h). Throws InvalidInput where a wall's
/// films have no such coordinates.
std::vector<WallSpec> on_films(const std::vector<WallSpec>& walls,
                               const SurfaceMesh& mesh,
                               const std::vector<int>& wall,
                               const std::vector<WallRim>& rims);

}  // namespace meniscus::walls
