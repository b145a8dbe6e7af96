/// What a level's smoother and its coarser levels need of a matrix and its
/// supports.
#pragma once

#include <vector>

#include "fea/solver/block_kernels.h"
#include "fea/solver/block_matrix.h"
#include "fea/solver/corner_mesh.h"
#include "fea/solver/node_freedom.h"

namespace meniscus::solver {

/// The freedom of the corner nodes.
NodeFreedom corner_freedom(const NodeFreedom& fine, const CornerMap& map);

/// Inverses of the diagonal blocks over `scale` on the free directions, 3 x 3
/// a node, row-major.
std::vector<double> inverse_blocks(const BlockMatrix<double>& matrix,
                                   double scale, const NodeFreedom& freedom);

/// The same for motions of aggregates, 6 x 6; what is no motion (a zero row)
/// stays zero.
std::vector<double> inverse_blocks(const BlockMatrix<double>& matrix,
                                   int nodes);

/// Translations and rotations about the middle in units of the part's size,
/// 3 x 6 a node, row-major, without what is held.
std::vector<double> rigid_motions(const Points& x, const NodeFreedom& freedom);

/// Blocks in single precision with padded rows (block_sweeps.h).
template <int B>
std::vector<float> padded(const std::vector<double>& blocks);

}  // namespace meniscus::solver
