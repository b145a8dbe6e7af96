/// Sparse symmetric factorisations that films, mesh motion and elasticity
/// share. CHOLMOD stays behind this door; 64-bit indices throughout.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "core/types.h"

namespace meniscus {

/// Column-major; only the lower triangle is read.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

enum class FactorKind {
  Cholesky,   // L L^T, supernodal (BLAS): positive definite matrices
  Indefinite  // L D L^T without pivoting: gives the inertia
};

/// Fill-reducing elimination order of the graph of `lower` by METIS nested
/// dissection; entry k is the k-th unknown to eliminate.
std::vector<int> nested_dissection(const SparseMatrix& lower);

/// The order of nodes with `block` unknowns each, from the order of nodes.
std::vector<int> expand_order(const std::vector<int>& node_order, int block);

class SymmetricFactor {
 public:
  /// Analyses the pattern. `order` empty: METIS on the matrix's own graph.
  SymmetricFactor(const SparseMatrix& lower, FactorKind kind,
                  const std::vector<int>& order = {});
  ~SymmetricFactor();
  SymmetricFactor(SymmetricFactor&&) noexcept;
  SymmetricFactor& operator=(SymmetricFactor&&) noexcept;

  /// Numeric factorisation of a matrix with the analysed pattern. False when
  /// the matrix is not positive definite (Cholesky), or has a zero pivot
  /// (Indefinite); failed_column() then tells where. Throws SolverError when
  /// memory runs out.
  bool factorize(const SparseMatrix& lower);

  /// Solves A x = b for one or several columns. Needs a factorisation.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

  int failed_column() const;
  /// Number of negative pivots (Indefinite): by Sylvester's law the number of
  /// negative eigenvalues of A.
  int negative_pivots() const;
  /// Entries of L, for memory figures.
  long long entries() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus
