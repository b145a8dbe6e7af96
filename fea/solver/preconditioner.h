/// What makes conjugate gradients fast: approximate inverses of a stiffness
/// matrix, built once at the base design and good for its neighbours.
#pragma once

#include <memory>
#include <vector>

#include "fea/solver/block_matrix.h"
#include "fea/solver/node_freedom.h"

namespace meniscus::solver {

/// A symmetric positive definite approximation of A^-1 on the free directions.
/// Vectors are K of padded layout (see multiply), K from 1 to 4.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// z = P r; z and its padding are 0 along held directions, where r must be 0
  /// too. Safe to call from several threads.
  virtual void apply(const std::vector<double>& r, std::vector<double>& z,
                     int K) const = 0;
};

/// Up to this many free unknowns a direct factor is as quick as multigrid.
inline constexpr int kFactorUnknowns = 1000;

/// Up to this many a factor of the matrix itself in double precision (a minute,
/// 2 GB) is tried where another preconditioner does not serve: multigrid in
/// single precision that finds a matrix not positive definite, walls of thin
/// elements, a base design too far away.
inline constexpr int kSecondChance = 200000;

/// Iterations after which that factor is the quicker way, at n unknowns: of
/// multigrid one costs as n, a factor of a solid as n^2; of another design's
/// factor one costs a part of a new factor.
inline int multigrid_patience(int n) { return n > 10000 ? n / 200 : 50; }
inline constexpr int kFactorPatience = 30;

/// The Cholesky factor of the matrix itself.
std::unique_ptr<Preconditioner> make_direct(const BlockPattern& pattern,
                                            const BlockMatrix<double>& matrix,
                                            const NodeFreedom& freedom);

}  // namespace meniscus::solver
