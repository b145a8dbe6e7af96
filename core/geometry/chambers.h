/// The chambers into which a surface's facets part space: bodies, cavities and
/// the outside.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/facet_tree.h"
#include "core/geometry/surface_mesh.h"

namespace meniscus {

/// A closed sheet of facet sides that look into one chamber. A chamber has one
/// shell of positive volume around it, and one of negative volume around each
/// part that floats in it; the outside has only the latter.
struct Shell {
  int body = -1;        // on its sides; -1: outside or a cavity
  double volume = 0.0;  // [length^3]
  int part = 0;         // connected part of the surface
  int facet = -1;       // the first that has a side in it
};

struct Chambers {
  std::vector<Shell> shells;  // in order of their first side
  std::vector<int> shell_of;  // per side, see facet_side
  std::vector<int> part_of;   // per facet: parts are connected by edges
  int parts = 0;
};

/// Of a surface whose facets close bodies: see check_surface.
Chambers find_chambers(const SurfaceMesh& mesh);

/// What a part of the surface floats in.
struct Surrounding {
  int body = -1;
  int facet = -1;  // that is seen from it; -1: none
};

/// Per part, by rays from its outermost corners, the majority of three since a
/// ray may graze an edge. None for a part that touches others with every
/// corner tried. O(n log n).
std::vector<std::optional<Surrounding>> find_surroundings(
    const SurfaceMesh& mesh, const Chambers& chambers, const FacetTree& tree);

}  // namespace meniscus
