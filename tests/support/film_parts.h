/// Parts of films with known shapes, as closed meshes with exact rims.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cad/solid/film_solid.h"

namespace meniscus {

struct FilmPart {
  SurfaceMesh mesh;
  std::vector<solid::NamedRim> rims;
  std::vector<std::string> caps;
  double edge = 0.0;
};

solid::FilmSolid solid_of(const FilmPart& part);

using Height = std::function<double(double x, double y)>;

/// Film "skin" over a flat disk "floor" of radius 20: z = height(x, y), 0 on
/// the rim; `rings` edges from the middle to the rim.
FilmPart dome(int rings, const Height& height);

/// Cap of a sphere over the same disk with its pole at `rise`, also more than a
/// half of one; facets evenly along its meridians.
FilmPart ball_cap(int rings, double rise);

/// Closed film "skin": an ellipsoid about (3, 2, 1) with these half axes.
FilmPart ellipsoid(int rings, const Vec3& half_axes);

/// Film "skin" of revolution about z up to `height` between flat ends "bottom"
/// and "top", `around` edges on each rim; a bore of a quarter of the lower
/// radius, film "bore", where asked.
FilmPart spool(int around, double height,
               const std::function<double(double z)>& radius,
               bool bored = false);

/// A film "skin" over a square of side 40 with its corners on a polygon.
FilmPart square_dome(int half, double rise);

/// Every edge once each way, loops closed.
void expect_closed(const solid::Brep& brep);

}  // namespace meniscus
