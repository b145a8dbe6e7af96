/// Which of many points make a surface of six-node triangles. The points may
/// go anywhere: the surface follows, and is linear in them.
#pragma once

#include <map>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

struct SurfaceNodes {
  SurfaceMesh mesh;         // facets by corners; it has no points
  std::vector<int> corner;  // per corner: its point
  std::vector<Edge> edges;  // as those of QuadraticSurface, by corners
  std::vector<Triangle> facet_edges;
  std::vector<int> mid;  // per edge: its point, or -1: half way between corners

  QuadraticSurface at(const Points& points) const;

  /// at() transposed: from a gradient by the surface's corners and mid-sides,
  /// one each, that by all `points` points. Throws MeshError for other counts.
  Points transpose(const Points& by_corners, const Points& by_mid_sides,
                   std::size_t points) const;
};

/// A triangulation refined 1:4, once or again: the point between two others
/// (lower number first), at each level.
using EdgeMiddles = std::map<Edge, int>;

/// The nodes of `mesh` whose corner i is point corner[i]. Mid-sides are the
/// edges' middles, but half way where there is none or where `straight` (one
/// char per point) says so.
SurfaceNodes surface_nodes(SurfaceMesh mesh, std::vector<int> corner,
                           const EdgeMiddles& middles,
                           const std::vector<char>& straight);

/// Makes edges straight, all three of a facet whose middles fold it at these
/// points: where the normal area at a node falls below a fifth of the flat
/// facet's. Returns how many edges.
int straighten_folded(SurfaceNodes& nodes, const Points& points);

/// The surface with the marked facets (one char each) in four, facets that have
/// two neighbours in four too, and those with one such neighbour in two ("red,
/// green": Bank, Sherman, Weiser 1983). All old corners stay with their
/// numbers; mid-sides are again points where `middles` has two levels. Throws
/// MeshError for an edge that should be halved and has no middle, and for marks
/// that do not fit.
SurfaceNodes split_facets(const SurfaceNodes& nodes,
                          const std::vector<char>& marked,
                          const EdgeMiddles& middles,
                          const std::vector<char>& straight);

}  // namespace meniscus
