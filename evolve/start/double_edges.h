/// Edges that a face's filling has twice once its rim is joined to others.
#pragma once

#include <set>
#include <vector>

#include "core/geometry/surface_mesh.h"
#include "core/types.h"

namespace meniscus::start {

/// `filling` is a face laid into a plane; `ids` are the vertices that its first
/// points, those of its loops, become: seams and neighbours have the same.
/// Edges across the face that it then has twice, or that are among `taken`, all
/// edges between vertices of loops so far, are cut in two, from a vertex back
/// to itself about a tip in three; those left join `taken`. New points come
/// last.
void cut_doubles(const std::vector<int>& ids, std::set<Edge>& taken,
                 SurfaceMesh& filling);

}  // namespace meniscus::start
