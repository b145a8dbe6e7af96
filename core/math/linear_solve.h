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

/// Parts of a graph, 2^levels of them, by METIS's recursive bisection, so that
/// part k and k ^ 1 are halves of one, and so on up: one number per vertex.
/// `neighbors` of vertex v stand from start[v] to start[v + 1].
std::vector<int> bisected_graph(const std::vector<int>& start,
                                const std::vector<int>& neighbors, int levels);

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

  /// With a Cholesky factor of A whose last `count` unknowns the given order
  /// has last, B, and the others, I: A_BB - A_BI A_II^-1 A_IB, both triangles.
  Eigen::MatrixXd schur_complement(int count) const;
  /// With such a factor: A_II^-1 of the leading rows; the last `count` rows are
  /// not read, and are 0 in what is returned.
  Eigen::MatrixXd solve_leading(const Eigen::MatrixXd& right, int count) const;

  int failed_column() const;
  /// Number of negative pivots (Indefinite): by Sylvester's law the number of
  /// negative eigenvalues of A.
  int negative_pivots() const;
  /// Entries of L, for memory figures.
  long long entries() const;

 private:
  void check_rows(const Eigen::MatrixXd& right) const;
  void count_solve(Eigen::Index columns) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus
