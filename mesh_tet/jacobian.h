/// The Jacobian determinant of a ten-node tetrahedron, bounded everywhere.
#pragma once

#include <array>

#include "core/types.h"

namespace meniscus::mesh_tet {

/// Jacobian matrices at the corners. The matrix is linear in the barycentric
/// coordinates, its determinant a cubic polynomial.
using CornerJacobians = std::array<Mat3, 4>;

/// Of a ten-node element, node order as TetMesh.
CornerJacobians corner_jacobians(const std::array<Vec3, 10>& x);

/// Mean of the determinant over the element: 6 x its volume.
double mean_determinant(const CornerJacobians& jacobians);

/// Whether the determinant is above `bound` everywhere on the element. Parts
/// are halved `depth` times before a doubtful element counts as bad.
bool determinant_above(const CornerJacobians& jacobians, double bound,
                       int depth = 3);

}  // namespace meniscus::mesh_tet
