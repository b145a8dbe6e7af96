/// Superconvergent patch recovery of stresses.
#pragma once

#include <vector>

#include "core/tet_mesh.h"
#include "fea/point_stress.h"
#include "fea/region_nodes.h"
#include "fea/stress.h"

namespace meniscus {

/// A stress that is continuous within each region: values at its nodes,
/// between them the element's shape functions.
struct RecoveredStress {
  RegionNodes nodes;
  std::vector<Stress> value;  // per copy of a node [pressure]
};

/// Zienkiewicz and Zhu, The superconvergent patch recovery and a posteriori
/// error estimates, part 1 (1992): about every corner that elements of one
/// region surround, a polynomial of the element's order (linear for four
/// nodes, complete quadratic for ten) is fitted by least squares to the points
/// of these elements. A corner takes its own polynomial, a mid-side the mean of
/// its two ends', a node on the region's boundary the mean of those of the
/// surrounded corners in its elements, or one element farther. Where there are
/// none (a wall one element thick) a linear polynomial of a corner's own
/// elements serves: quadratics seen from one side overshoot. The same bits for
/// any number of threads.
RecoveredStress recover_by_patches(const TetMesh& mesh,
                                   const PointStress& points);

/// One value per node of the mesh: on interfaces that of the region with the
/// largest von Mises stress.
StressField nodal_stress(const TetMesh& mesh, const RecoveredStress& recovered);

}  // namespace meniscus
