/// Sparse matrices of a shell on its free numbers.
#pragma once

#include <functional>
#include <vector>

#include "core/math/linear_solve.h"
#include "fea/shell/facet_matrices.h"
#include "fea/shell/shell_mesh.h"
#include "fea/shell/shell_supports.h"

namespace meniscus::shell {

using MatrixOfFacet = std::function<FacetMatrix(int facet)>;

/// The pattern that all matrices of one shell and its supports share, built
/// once.
class ShellAssembly {
 public:
  /// Facets are between the unknowns' seats (rigid_rims.h has such a mesh).
  ShellAssembly(const ShellMesh& mesh, const ShellFreedom& freedom);

  /// Sums of all facets' matrices, computed in threads and added in the facets'
  /// order: the same bits for any number of threads. Lower triangle, with whole
  /// blocks on the diagonal.
  SparseMatrix sum(const MatrixOfFacet& matrix) const;

  /// Order of elimination of the unknowns by nested dissection of the nodes but
  /// the last ones, which follow.
  std::vector<int> elimination_order(int last_nodes = 0) const;

 private:
  void add(int facet, const FacetMatrix& K, SparseMatrix& sum) const;

  const ShellMesh& mesh_;
  const ShellFreedom& freedom_;
  std::vector<int> start_;  // per node: its first block; nodes + 1
  std::vector<int> row_;    // per block: its row's node, ascending, own first
  std::vector<int> place_;  // per block: its first entry in a column
};

}  // namespace meniscus::shell
