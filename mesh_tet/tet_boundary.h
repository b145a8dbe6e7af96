/// The boundary of a tetrahedral mesh, matched with the surface it fills.
#pragma once

#include <string>

#include "core/surface_mesh.h"
#include "core/tet_mesh.h"

namespace meniscus {

/// Fills the faces of `mesh` (order 1, elements of positive volume) with the
/// facets of `surface`, facet f as face f, with their labels and the element
/// behind. Returns what is wrong, empty if nothing: a facet without element or
/// with two, a face inside out, a boundary face that is no facet, or elements
/// that overlap. Linear time.
std::string attach_surface(const SurfaceMesh& surface, TetMesh& mesh);

}  // namespace meniscus
