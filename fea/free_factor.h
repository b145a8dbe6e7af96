/// Direct factorisation of a stiffness matrix on its free degrees of freedom.
#pragma once

#include <vector>

#include "core/linear_solve.h"
#include "fea/block_matrix.h"

namespace meniscus {

/// The rows and columns of the degrees of freedom that are not fixed, factored
/// by a supernodal Cholesky; elimination order by nested dissection of the
/// graph of nodes.
class FreeFactor {
 public:
  /// `fixed`: one flag per degree of freedom, 3 per node. Throws SolverError
  /// when the matrix is not positive definite or memory runs out.
  FreeFactor(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
             const std::vector<char>& fixed);

  int size() const { return static_cast<int>(dof_.size()); }

  /// z = A^-1 r for K interleaved vectors (see multiply); z is 0 where fixed.
  void solve(const double* r, double* z, int K) const;

 private:
  std::vector<int> dof_;  // free unknown -> degree of freedom
  SymmetricFactor factor_;
};

}  // namespace meniscus
