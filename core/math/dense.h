/// The one compiled door to Eigen's dense decompositions. Their templates cost
/// seconds in each source that names one; here each is compiled once. The type
/// of an argument chooses the instance, and with it the bits: matrices of fixed
/// size sum in another order than those of any size. Nothing throws; entries
/// that are not finite come back as such.
#pragma once

#include <Eigen/Core>

#include "core/types.h"

namespace meniscus {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using RowMatrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Of a symmetric N x N matrix A: A vectors = vectors diag(values).
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;   // ascending
  Eigen::Matrix<double, N, N> vectors;  // orthonormal columns
};

/// Reads the lower triangle of A.
SymmetricEigen<3> symmetric_eigen(const Mat3& A);
SymmetricEigen<6> symmetric_eigen(const Matrix6& A);
SymmetricEigen<Eigen::Dynamic> symmetric_eigen(const Eigen::MatrixXd& A);

/// Ascending eigenvalues of the symmetric tridiagonal matrix with n entries in
/// the diagonal and n - 1 beside it.
VectorX tridiagonal_eigenvalues(const VectorX& diagonal, const VectorX& beside);

/// x with A x = b for a symmetric semidefinite A by L D L^T with pivots; reads
/// the lower triangle. Along a pivot of 0 x is 0.
Vec3 solve_ldlt3(const Mat3& A, const Vec3& b);
Eigen::Vector4d solve_ldlt4(const Eigen::Matrix4d& A, const Eigen::Vector4d& b);
VectorX solve_ldlt(const Eigen::MatrixXd& A, const VectorX& b);

/// x with A x = b by LU with pivots in rows and columns.
Vec3 solve_lu(const Mat3& A, const Vec3& b);

Matrix6 inverse_of(const Matrix6& A);
RowMatrix6 inverse_of(const RowMatrix6& A);

/// min |A x - b| by QR with pivots: entries beyond A's numerical rank are 0.
struct LeastSquares {
  VectorX x;
  Eigen::Index rank = 0;
};
LeastSquares least_squares(const Eigen::MatrixXd& A, const VectorX& b);

/// The shortest x of those that minimise |A x - b|, by a complete orthogonal
/// decomposition. Of n walls' normals N, n x 3: A = N a move in space by which
/// n level sets change by b, A = N^T the forces along the normals that make up
/// b.
VectorX least_norm(const Eigen::MatrixXd& A, const VectorX& b);

/// Moore and Penrose's, by a complete orthogonal decomposition.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

}  // namespace meniscus
