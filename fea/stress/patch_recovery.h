/// Superconvergent patch recovery of stresses.
#pragma once

#include <vector>

#include "core/geometry/tet_mesh.h"
#include "fea/element/point_covector.h"
#include "fea/element/point_stress.h"
#include "fea/element/region_nodes.h"
#include "fea/stress/stress.h"

namespace meniscus::stress {

/// A stress that is continuous within each region: values at its nodes,
/// between them the element's shape functions.
struct RecoveredStress {
  element::RegionNodes nodes;
  std::vector<element::Stress> value;  // per copy of a node [pressure]
};

/// Zienkiewicz and Zhu, The superconvergent patch recovery and a posteriori
/// error estimates, part 1 (1992): about every corner that elements of one
/// region surround, a polynomial of the element's order (linear for four
/// nodes, complete quadratic for ten) is fitted by least squares to the points
/// of these elements; the corner takes its value, a mid-side the mean of its
/// two ends'. On a region's boundary the paper extrapolates from inside, which
/// cuts peaks off; here the polynomial is fitted to two rings of elements, the
/// nearer points weighing more (docs/verification.md has both). The same bits
/// for any number of threads.
RecoveredStress recover_by_patches(const TetMesh& mesh,
                                   const element::PointStress& points);

/// The transpose of recover_by_patches() with its derivative by the nodes:
/// `by_value` is what a number changes by each value of `nodes`, the copies
/// that it gave; adds what it changes by the points and by the nodes. Costs
/// what its patches cost whose values have a part in the number. The same bits
/// for any number of threads.
void transpose_patches(const TetMesh& mesh, const element::PointStress& points,
                       const element::RegionNodes& nodes,
                       const std::vector<element::Stress>& by_value,
                       element::PointCovector& by);

/// One value per node of the mesh: on interfaces that of the region with the
/// largest von Mises stress.
StressField nodal_stress(const TetMesh& mesh, const RecoveredStress& recovered);

}  // namespace meniscus::stress
