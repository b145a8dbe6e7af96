/// Nodes gathered into the clusters that become one coarse node each.
#pragma once

#include <vector>

#include "fea/solver/block_matrix.h"

namespace meniscus::solver {

/// Both halves of a pattern: per row, neighbours in ascending order, and where
/// their blocks are stored; those above the diagonal transposed.
struct FullRows {
  std::vector<int> start;
  std::vector<int> node;
  std::vector<int> block;

  explicit FullRows(const BlockPattern& pattern);
};

/// Cluster of every node, -1 where it is not active.
struct Clusters {
  std::vector<int> of;
  int count = 0;
};

/// A node none of whose neighbours is taken takes them all; those left over
/// join the first neighbour's cluster, or make their own (Vanek, Mandel,
/// Brezina 1996, algorithm 5.1, all couplings strong).
Clusters cluster(const FullRows& rows, const std::vector<char>& active);

/// Nodes of each cluster, ascending.
struct Members {
  std::vector<int> start;
  std::vector<int> node;

  explicit Members(const Clusters& clusters);
};

}  // namespace meniscus::solver
