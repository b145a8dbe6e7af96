/// Which facets meet at which edge, and which of their sides look at each
/// other there.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus {

/// One facet's use of an edge.
struct EdgeUse {
  Edge edge;     // first id < second id
  int facet;     // index into the mesh's facets
  bool forward;  // the facet runs from the first id to the second

  /// The facet's sides that are met first when one turns about the edge, by
  /// the right hand rule about first -> second: into the facet, and out of it.
  int side_before() const { return forward ? 2 * facet : 2 * facet + 1; }
  int side_after() const { return forward ? 2 * facet + 1 : 2 * facet; }
};

/// Calls visit(uses) once per edge, in order of its ids, with the uses of all
/// facets flagged in `facets` (one char per facet, corner ids sound and
/// distinct). Uses are in order of facet id. O(n log k) for k uses at a point.
void for_each_edge(const SurfaceMesh& mesh, const std::vector<char>& facets,
                   const std::function<void(std::span<EdgeUse>)>& visit);

/// Sorts the uses of one edge by the angle of their facets about it, so that
/// side_after() of each looks at side_before() of the next, and that of the
/// last at the first.
void sort_around(const SurfaceMesh& mesh, std::span<EdgeUse> uses);

}  // namespace meniscus
