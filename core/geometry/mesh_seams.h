/// How a mesh is put together: its pieces and the seams between them.
#pragma once

#include "core/geometry/tet_mesh.h"

namespace meniscus {

/// Elements of one body that share corners, counted as one piece.
int piece_count(const TetMesh& mesh);

/// Length of the lines where faces between bodies come to the outer surface
/// [length]: what a weld along every seam would be long. 0 of one body.
/// Quadratic edges by three points.
double seam_length(const TetMesh& mesh);

}  // namespace meniscus
