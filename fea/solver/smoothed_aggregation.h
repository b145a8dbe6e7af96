/// A coarser level by smoothed aggregation (Vanek, Mandel, Brezina 1996): nodes
/// in clusters, each with the six rigid motions as its coarse unknowns.
#pragma once

#include <vector>

#include "fea/solver/block_matrix.h"

namespace meniscus::solver {

inline constexpr int kRigidMotions = 6;

/// One level's operator, B x B blocks.
struct LevelOperator {
  BlockPattern pattern;  // rows only, no elements
  BlockMatrix<double> matrix;
};

/// What coarsening reads of the finer level; nothing is kept.
struct FineLevel {
  const BlockPattern* pattern;
  const BlockMatrix<double>* matrix;
  const std::vector<double>* inverse;  // of diagonal blocks, B x B each; held
                                       // directions in the null space
  const std::vector<double>* motions;  // B x 6 a node, row-major: the rigid
                                       // motions, zero along held directions
};

/// x_fine = P x_coarse: B x 6 blocks, row-major, with kBlockPadding at the end.
struct Prolongation {
  int fine_block = 3;
  std::vector<int> start;   // per fine node
  std::vector<int> column;  // aggregate
  std::vector<float> value;
  // By aggregate: fine nodes, which block it is above, and a copy of the block,
  // so that restriction streams through memory as interpolation does.
  std::vector<int> row_start;
  std::vector<int> row;
  std::vector<int> block;
  std::vector<float> row_value;
};

struct AggregateLevel {
  LevelOperator coarse;         // P^T A P, 6 x 6 blocks
  std::vector<double> motions;  // 6 x 6 an aggregate: rigid motions, coarse
  Prolongation prolongation;
};

/// For B = 3 or 6. A rigid motion that an aggregate cannot make on its own
/// (a bar's turning about itself, held directions) leaves a zero row and
/// column in the coarse operator. Same bits for any number of threads.
template <int B>
AggregateLevel aggregate(const FineLevel& fine);

}  // namespace meniscus::solver
