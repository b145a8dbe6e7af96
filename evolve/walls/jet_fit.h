/// Normals and principal curvatures of a sheet by fitted polynomials.
#pragma once

#include <vector>

#include "evolve/walls/sheet.h"

namespace meniscus::walls {

/// Principal curvatures [1/length], positive where the sheet bends away from
/// its normal: a sphere of outward normals has both 1/R. k1 >= k2.
struct Jet {
  Vec3 normal = Vec3::UnitZ();  // unit, to the facets' side
  double k1 = 0.0;
  double k2 = 0.0;
};

/// One jet per vertex: z(x, y) of degree 3 through the vertex, fitted to the
/// points of the rings around it, never across a crease (Cazals & Pouget 2005:
/// normals are of order 3 in the edge length, curvatures of order 2); of degree
/// 2 where fewer than 14 points are at hand, and the normal alone, weighted
/// after Max 1999, with fewer than 5. Vertices on a crease have that normal and
/// curvatures 0.
std::vector<Jet> fit_jets(const Sheet& sheet);

}  // namespace meniscus::walls
