#include "core/math/partial_cholesky.h"

#include <algorithm>
#include <cblas.h>
#include <cstddef>
#include <vector>

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

/// Rows of both arrays: tiles do not cross from one's columns to the other's.
struct Tile {
  int first;
  int count;
};

std::vector<Tile> tiles_between(int first, int border, int last) {
  std::vector<Tile> tiles;
  while (first < last) {
    const int end = first < border ? border : last;
    tiles.push_back({first, std::min(kTile, end - first)});
    first += tiles.back().count;
  }
  return tiles;
}

/// Those rows of the panel's columns become those of L.
void solve_panel(Matrix& A, int panel, int width, const Tile& rows) {
  const int stride = static_cast<int>(A.rows());
  const double* pivots = &A.coeffRef(panel, panel);
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
              rows.count, width, 1.0, pivots, stride,
              &A.coeffRef(rows.first, panel), stride);
}

/// A tile of what is left loses the panel's product.
void update_tile(Matrix& leading, Matrix& rest, int panel, int width,
                 const Tile& rows, const Tile& columns) {
  const int n = static_cast<int>(leading.rows());
  const int border = static_cast<int>(leading.cols());
  const bool within = columns.first < border;
  double* tile =
      within ? &leading.coeffRef(rows.first, columns.first)
             : &rest.coeffRef(rows.first - border, columns.first - border);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows.count,
              columns.count, width, -1.0, &leading.coeffRef(rows.first, panel),
              n, &leading.coeffRef(columns.first, panel), n, 1.0, tile,
              within ? n : n - border);
}

}  // namespace

bool eliminate_leading(Matrix& leading, Matrix& rest) {
  const int n = static_cast<int>(leading.rows());
  const int count = static_cast<int>(leading.cols());
  for (int panel = 0; panel < count; panel += kPanel) {
    const int width = std::min(kPanel, count - panel);
    auto pivots = leading.block(panel, panel, width, width);
    const Eigen::LLT<Matrix> factor(pivots);
    if (factor.info() != Eigen::Success) {
      return false;
    }
    pivots.triangularView<Eigen::Lower>() = factor.matrixL();
    const std::vector<Tile> tiles = tiles_between(panel + width, count, n);
    const int last = static_cast<int>(tiles.size()) - 1;
    parallel_for(last + 1, [&](std::ptrdiff_t k) {
      prepare_blas();
      solve_panel(leading, panel, width, tiles[k]);
    });
    // Tile rows of the triangle, long with short, so that threads share evenly.
    parallel_for((last + 2) / 2, [&](std::ptrdiff_t k) {
      prepare_blas();
      const int pair[] = {static_cast<int>(k), last - static_cast<int>(k)};
      for (int half = 0; half < (pair[0] == pair[1] ? 1 : 2); ++half) {
        for (int c = 0; c <= pair[half]; ++c) {
          update_tile(leading, rest, panel, width, tiles[pair[half]], tiles[c]);
        }
      }
    });
    const double left = n - panel - width;
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
