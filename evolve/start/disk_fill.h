/// Fills a closed curve with triangles.
#pragma once

#include <functional>

#include "core/geometry/surface_mesh.h"

namespace meniscus::start {

/// Isotropic triangles of about `edge` inside the simple polygon `rim`
/// (planar, or one whose shadow along its area vector is simple): the rim
/// points come first with their numbers, no other lies on the rim, and facets
/// run along it in its direction. No labels. `edge_field`: the edge wanted at a
/// place instead. Throws MeshError when the rim crosses itself.
/// Ear clipping, then isotropic remeshing (Botsch and Kobbelt 2004).
SurfaceMesh fill_disk(
    const Points& rim, double edge,
    const std::function<double(const Vec3&)>& edge_field = {});

/// The same with holes: `holes` are closed polygons inside `rim`, in either
/// direction, clear of it and of each other; their points come after the
/// rim's. Throws MeshError also where a hole is not inside.
SurfaceMesh fill_disk(
    const Points& rim, const std::vector<Points>& holes, double edge,
    const std::function<double(const Vec3&)>& edge_field = {});

/// Isotropic triangles of the band between two closed curves, neither of which
/// need be planar: the points of `outer` come first, then those of `inner`, no
/// other lies on them, and facets run along `outer` in its direction. Lofted
/// (evolve/start/loft.h), then remeshed along itself.
SurfaceMesh fill_ring(const Points& outer, const Points& inner, double edge);

}  // namespace meniscus::start
