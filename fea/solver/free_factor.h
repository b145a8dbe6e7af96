/// Direct factorisation of a stiffness matrix on its free directions.
#pragma once

#include <vector>

#include "core/math/linear_solve.h"
#include "fea/solver/block_matrix.h"
#include "fea/solver/node_freedom.h"

namespace meniscus::solver {

/// The matrix on its free directions, factored by a supernodal Cholesky;
/// elimination order by nested dissection of the graph of nodes.
class FreeFactor {
 public:
  /// Throws SolverError when the matrix is not positive definite or memory
  /// runs out.
  FreeFactor(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
             const NodeFreedom& freedom);

  /// z = A^-1 r for K vectors of padded layout (see multiply); z is 0 along
  /// held directions.
  void solve(const double* r, double* z, int K) const;

 private:
  std::vector<int> start_;  // first unknown of each node; nodes + 1
  std::vector<int> held_;   // nodes whose free directions are ...
  std::vector<Mat3> axes_;  // ... the first columns of these
  SymmetricFactor factor_;
};

}  // namespace meniscus::solver
