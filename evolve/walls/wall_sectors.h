/// Which sides of facets look into the same sector about a vertex.
#pragma once

#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::walls {

/// An edge of a facet: it runs from this corner to the next.
struct Incidence {
  int facet = 0;
  int corner = 0;
};

struct Sectors {
  /// Per corner of a side, (2 facet + side) * 3 + corner with side 0 in front:
  /// the least of the corners at that vertex which are in its sector.
  std::vector<int> of_corner;
  std::vector<Incidence> rims;  // edges of one facet, by the ids of their ends
};

/// Of a film complex, manifold or not, however its facets are turned: sides
/// are of one sector where they follow each other about an edge at the vertex.
/// Nothing joins the two sides of a film at a rim.
Sectors find_sectors(const SurfaceMesh& mesh);

}  // namespace meniscus::walls
