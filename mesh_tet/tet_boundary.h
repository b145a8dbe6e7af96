/// The boundary of a tetrahedral mesh, matched with the surface it fills.
#pragma once

#include <string>

#include "core/geometry/surface_mesh.h"
#include "core/geometry/tet_mesh.h"

namespace meniscus::mesh_tet {

/// Fills the faces of `mesh` (order 1, elements of positive volume) with the
/// facets of `surface`, facet f as face f, with their labels and the elements
/// on their sides, and the elements' regions with the bodies that the facets
/// name. Returns what is wrong, empty if nothing: a facet that lacks an element
/// or has one too many, a boundary face that is no facet, elements that
/// overlap, or facets that put an element into two bodies. Linear time.
std::string attach_surface(const SurfaceMesh& surface, TetMesh& mesh);

}  // namespace meniscus::mesh_tet
