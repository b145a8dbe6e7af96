/// The facets of each face of a solid.
#pragma once

#include <functional>
#include <vector>

#include "core/geometry/surface_mesh.h"

namespace meniscus::solid {

/// Facets of one label that hang together by edges, in order of the first.
/// `ends`: the edge between two facets of one label where parts end
/// nevertheless.
std::vector<std::vector<int>> connected_parts(
    const SurfaceMesh& mesh,
    const std::function<bool(int facet, int other, const Edge& edge)>& ends);

/// The angle at which two facets meet, 0 in one plane [rad].
double angle_between(const SurfaceMesh& mesh, int facet, int other);

/// True where two facets lie in different planes.
bool is_crease(const SurfaceMesh& mesh, int facet, int other);

}  // namespace meniscus::solid
