#include "fea/solver/multi_vector.h"

#include <algorithm>

#include "fea/solver/block_kernels.h"
#include "fea/solver/conjugate_gradients.h"

namespace meniscus::solver {

namespace {

/// Rows whose products are summed in one piece, whatever the threads.
constexpr Eigen::Index kPiece = 3072;

/// work(piece, first row, rows). Always in a parallel region, so that Eigen's
/// own threads, which would cut sums elsewhere, stay away.
template <class Work>
void over_pieces(Eigen::Index rows, const Work& work) {
  const Eigen::Index pieces = (rows + kPiece - 1) / kPiece;
#pragma omp parallel for schedule(static)
  for (Eigen::Index p = 0; p < pieces; ++p) {
    const Eigen::Index first = p * kPiece;
    work(p, first, std::min(kPiece, rows - first));
  }
}

void pad(const ColumnsIn& x, std::vector<double>& padded) {
  const Eigen::Index K = x.cols();
  const Eigen::Index nodes = x.rows() / 3;
  padded.resize(static_cast<std::size_t>(nodes * K * kLanes<3>));
#pragma omp parallel for schedule(static)
  for (Eigen::Index i = 0; i < nodes; ++i) {
    for (Eigen::Index k = 0; k < K; ++k) {
      double* lane = padded.data() + (i * K + k) * kLanes<3>;
      Eigen::Map<Vec3>(lane, 3) = x.block<3, 1>(3 * i, k);
      lane[3] = 0.0;
    }
  }
}

void unpad(const std::vector<double>& padded, ColumnsOut x) {
  const Eigen::Index K = x.cols();
  const Eigen::Index nodes = x.rows() / 3;
#pragma omp parallel for schedule(static)
  for (Eigen::Index i = 0; i < nodes; ++i) {
    for (Eigen::Index k = 0; k < K; ++k) {
      x.block<3, 1>(3 * i, k) =
          Eigen::Map<const Vec3>(padded.data() + (i * K + k) * kLanes<3>);
    }
  }
}

template <class Matrix>
void multiply_any(const BlockPattern& pattern, const Matrix& A, const double* x,
                  double* y, int K) {
  const auto times = [&]<int Width>(std::integral_constant<int, Width>) {
    if constexpr (std::is_same_v<Matrix, NodalMatrix>) {
      multiply<Width>(pattern, A, x, y);
    } else {
      multiply<3, Width>(pattern, A, x, y);
    }
  };
  switch (K) {
    case 1:
      return times(std::integral_constant<int, 1>{});
    case 2:
      return times(std::integral_constant<int, 2>{});
    case 3:
      return times(std::integral_constant<int, 3>{});
    default:
      return times(std::integral_constant<int, 4>{});
  }
}

}  // namespace

Eigen::MatrixXd gram(const ColumnsIn& a, const ColumnsIn& b) {
  std::vector<Eigen::MatrixXd> part((a.rows() + kPiece - 1) / kPiece);
  over_pieces(
      a.rows(), [&](Eigen::Index p, Eigen::Index first, Eigen::Index rows) {
        part[p].noalias() =
            a.middleRows(first, rows).transpose() * b.middleRows(first, rows);
      });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  for (const Eigen::MatrixXd& p : part) {
    sum += p;
  }
  return sum;
}

void combine(const Eigen::MatrixXd& C, ColumnsOut S) {
  over_pieces(S.rows(),
              [&](Eigen::Index, Eigen::Index first, Eigen::Index rows) {
                const Eigen::MatrixXd product = S.middleRows(first, rows) * C;
                S.block(first, 0, rows, C.cols()) = product;
              });
}

void subtract(const ColumnsIn& a, const Eigen::MatrixXd& C, ColumnsOut b) {
  over_pieces(
      b.rows(), [&](Eigen::Index, Eigen::Index first, Eigen::Index rows) {
        b.middleRows(first, rows).noalias() -= a.middleRows(first, rows) * C;
      });
}

void project(const NodeFreedom& freedom, ColumnsOut v) {
  for (Eigen::Index k = 0; k < v.cols(); ++k) {
    for (std::size_t h = 0; h < freedom.held.size(); ++h) {
      auto node = v.block<3, 1>(3L * freedom.held[h], k);
      node = (freedom.projector[h] * node).eval();
    }
  }
}

/// product(padded x, padded y, K) for the columns, up to four at a time.
template <class Product>
void ColumnProducts::by_fours(const ColumnsIn& x, ColumnsOut& y,
                              const Product& product) {
  for (Eigen::Index first = 0; first < x.cols(); first += kMostColumns) {
    const Eigen::Index K =
        std::min<Eigen::Index>(kMostColumns, x.cols() - first);
    pad(x.middleCols(first, K), from_);
    to_.resize(from_.size());
    product(from_, to_, static_cast<int>(K));
    unpad(to_, y.middleCols(first, K));
  }
  project(freedom_, y);
}

void ColumnProducts::apply(const BlockMatrix<double>& A, const ColumnsIn& x,
                           ColumnsOut y) {
  by_fours(x, y, [&](const auto& from, auto& to, int K) {
    multiply_any(pattern_, A, from.data(), to.data(), K);
  });
}

void ColumnProducts::apply(const NodalMatrix& A, const ColumnsIn& x,
                           ColumnsOut y) {
  by_fours(x, y, [&](const auto& from, auto& to, int K) {
    multiply_any(pattern_, A, from.data(), to.data(), K);
  });
}

void ColumnProducts::apply(const Preconditioner& A, const ColumnsIn& x,
                           ColumnsOut y) {
  by_fours(x, y,
           [&](const auto& from, auto& to, int K) { A.apply(from, to, K); });
}

}  // namespace meniscus::solver
