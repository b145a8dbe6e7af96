#include "core/math/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace meniscus {

namespace {

template <int N>
SymmetricEigen<N> eigen_of(const Eigen::Matrix<double, N, N>& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

SymmetricEigen<3> symmetric_eigen(const Mat3& A) { return eigen_of<3>(A); }

SymmetricEigen<6> symmetric_eigen(const Matrix6& A) { return eigen_of<6>(A); }

SymmetricEigen<Eigen::Dynamic> symmetric_eigen(const Eigen::MatrixXd& A) {
  return eigen_of<Eigen::Dynamic>(A);
}

VectorX tridiagonal_eigenvalues(const VectorX& diagonal,
                                const VectorX& beside) {
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

Vec3 solve_ldlt3(const Mat3& A, const Vec3& b) { return A.ldlt().solve(b); }

Eigen::Vector4d solve_ldlt4(const Eigen::Matrix4d& A,
                            const Eigen::Vector4d& b) {
  return A.ldlt().solve(b);
}

VectorX solve_ldlt(const Eigen::MatrixXd& A, const VectorX& b) {
  return A.ldlt().solve(b);
}

Vec3 solve_lu(const Mat3& A, const Vec3& b) { return A.fullPivLu().solve(b); }

Matrix6 inverse_of(const Matrix6& A) { return A.inverse(); }

RowMatrix6 inverse_of(const RowMatrix6& A) { return A.inverse(); }

LeastSquares least_squares(const Eigen::MatrixXd& A, const VectorX& b) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(A);
  return {factor.solve(b), factor.rank()};
}

VectorX least_norm(const Eigen::MatrixXd& A, const VectorX& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) {
  return A.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace meniscus
