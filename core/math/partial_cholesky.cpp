#include "core/math/partial_cholesky.h"

#include <algorithm>
#include <cblas.h>
#include <cstddef>

#include <Eigen/Cholesky>

#include "core/math/blas_threads.h"
#include "core/operation_count.h"
#include "core/parallel_for.h"

namespace meniscus {

namespace {

using Matrix = Eigen::MatrixXd;

/// Columns eliminated at once, and the side of the tiles that threads take.
constexpr int kPanel = 192;
constexpr int kTile = 384;

/// Rows `first` on of the panel's columns become those of L.
void solve_panel(Matrix& A, int panel, int width, int first, int rows) {
  const int stride = static_cast<int>(A.rows());
  const double* pivots = &A.coeffRef(panel, panel);
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
              rows, width, 1.0, pivots, stride, &A.coeffRef(first, panel),
              stride);
}

/// A tile of what is left loses the panel's product.
void update_tile(Matrix& A, int panel, int width, int row, int column) {
  const int n = static_cast<int>(A.rows());
  const int rows = std::min(kTile, n - row);
  const int columns = std::min(kTile, n - column);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, width,
              -1.0, &A.coeffRef(row, panel), n, &A.coeffRef(column, panel), n,
              1.0, &A.coeffRef(row, column), n);
}

}  // namespace

bool eliminate_leading(Matrix& A, int count) {
  const int n = static_cast<int>(A.rows());
  for (int panel = 0; panel < count; panel += kPanel) {
    const int width = std::min(kPanel, count - panel);
    const int first = panel + width;
    auto pivots = A.block(panel, panel, width, width);
    const Eigen::LLT<Matrix> factor(pivots);
    if (factor.info() != Eigen::Success) {
      return false;
    }
    pivots.triangularView<Eigen::Lower>() = factor.matrixL();
    const int tiles = (n - first + kTile - 1) / kTile;
    parallel_for(tiles, [&](std::ptrdiff_t k) {
      prepare_blas();
      const int row = first + static_cast<int>(k) * kTile;
      solve_panel(A, panel, width, row, std::min(kTile, n - row));
    });
    // Tile rows of the triangle, long with short, so that threads share evenly.
    parallel_for((tiles + 1) / 2, [&](std::ptrdiff_t k) {
      prepare_blas();
      const int pair[] = {static_cast<int>(k), tiles - 1 - static_cast<int>(k)};
      for (int half = 0; half < (pair[0] == pair[1] ? 1 : 2); ++half) {
        for (int c = 0; c <= pair[half]; ++c) {
          update_tile(A, panel, width, first + pair[half] * kTile,
                      first + c * kTile);
        }
      }
    });
    const double left = n - first;
    count_operations(width * (left * left + left * width));
  }
  return true;
}

void solve_leading_lower(const Matrix& L, Matrix& b) {
  const auto count = L.cols();
  auto y = b.topRows(count);
  L.topRows(count).triangularView<Eigen::Lower>().solveInPlace(y);
  b.bottomRows(b.rows() - count).noalias() -=
      L.bottomRows(L.rows() - count) * y;
}

void solve_leading_upper(const Matrix& L, Matrix& b) {
  const auto count = L.cols();
  auto x = b.topRows(count);
  x.noalias() -= L.bottomRows(L.rows() - count).transpose() *
                 b.bottomRows(b.rows() - count);
  L.topRows(count).triangularView<Eigen::Lower>().transpose().solveInPlace(x);
}

}  // namespace meniscus
