/// A shell cut in halves again and again: which nodes are inside of a part,
/// and which lie on the cuts (nested dissection: George, SIAM J. Numer. Anal.
/// 10, 1973).
#pragma once

#include <vector>

#include "fea/shell/shell_mesh.h"

namespace meniscus::shell {

/// Of facets, or of two parts together.
struct Part {
  std::vector<int> own;       // nodes of no other part, but for its halves
  std::vector<int> boundary;  // nodes of others too; both ascending
};

/// A binary tree: part k's halves are 2 k and 2 k + 1, the whole shell is 1,
/// and 0 is none. Leaves stand last.
struct Substructures {
  int levels = 0;
  std::vector<Part> parts;
  std::vector<std::vector<int>> facets;  // of each leaf

  int leaf_count() const { return 1 << levels; }
  /// The tree's number of a leaf.
  int part_of(int leaf) const { return leaf_count() + leaf; }
};

/// Leaves of about equally many facets: 2^levels of them. Nodes of no facet are
/// of no part, and facets may have a place several times (rigid_rims.h).
Substructures cut_shell(const ShellMesh& mesh, int levels);

}  // namespace meniscus::shell
