/// A triangulation with its nested refinements, as a film model holds one.
#pragma once

#include "core/geometry/surface_nodes.h"

namespace meniscus {

struct NestedSurface {
  SurfaceNodes nodes;  // of the coarsest level
  EdgeMiddles middles;
  Points points;  // of all levels: middles half way between their ends
  std::vector<char> straight;

  QuadraticSurface surface() const { return nodes.at(points); }
  /// The coarsest level with the marked facets split.
  QuadraticSurface split(const std::vector<char>& marked) const {
    return split_facets(nodes, marked, middles, straight).at(points);
  }
};

/// `base` and `levels` refinements of it, all of its flat facets.
NestedSurface nested_surface(const SurfaceMesh& base, int levels);

}  // namespace meniscus
