/// What makes conjugate gradients fast: approximate inverses of a stiffness
/// matrix, built once at the base design and good for its neighbours.
#pragma once

#include <memory>
#include <vector>

#include "fea/block_matrix.h"

namespace meniscus {

/// A symmetric positive definite approximation of A^-1 on the free degrees of
/// freedom. Vectors are K interleaved ones (see multiply), K from 1 to 4.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// z = P r; z is 0 at fixed degrees of freedom, where r is not read. Safe to
  /// call from several threads.
  virtual void apply(const std::vector<double>& r, std::vector<double>& z,
                     int K) const = 0;
};

/// The Cholesky factor of the matrix itself.
std::unique_ptr<Preconditioner> make_direct(const BlockPattern& pattern,
                                            const BlockMatrix<double>& matrix,
                                            const std::vector<char>& fixed);

/// How the ten-node mesh and its four-node corner mesh hang together, in the
/// solver's numbering.
struct CornerMap {
  std::vector<int> corner;               // coarse node -> fine node
  std::vector<int> mid;                  // fine mid-side nodes ...
  std::vector<std::array<int, 2>> ends;  // ... and the coarse ends of each
};

/// Blocks below the diagonal in single precision, divided by `scale`; shared
/// by the load cases, whatever they fix.
struct SmootherMatrix {
  double scale = 1.0;
  std::vector<float> lower;
};
SmootherMatrix make_smoother_matrix(const BlockMatrix<double>& matrix);

struct MultigridInput {
  const BlockPattern* pattern;         // kept: must outlive the preconditioner
  const BlockMatrix<double>* matrix;   // read at construction only
  const SmootherMatrix* smoother;      // kept
  const CornerMap* map;                // kept
  const BlockPattern* coarse_pattern;  // read at construction only
  const BlockMatrix<double>* coarse_matrix;  // read at construction only
  const std::vector<char>* fixed;            // 3 per fine node
};

/// One V-cycle over two levels: symmetric Gauss-Seidel by 3 x 3 blocks in
/// single precision on the ten-node mesh, a Cholesky factor of the four-node
/// one (p-multigrid; on straight elements the coarse matrix is the Galerkin
/// one).
std::unique_ptr<Preconditioner> make_multigrid(const MultigridInput& input);

}  // namespace meniscus
