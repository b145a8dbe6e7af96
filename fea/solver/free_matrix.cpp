#include "fea/solver/free_matrix.h"

#include <algorithm>

#include <Eigen/Core>

#include "core/math/dense.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

FreeBasis free_basis(const Mat3& projector) {
  FreeBasis basis;
  basis.rank = 0;
  const Mat3 diagonal = projector.diagonal().asDiagonal();
  Mat3 vectors = Mat3::Identity();
  Vec3 values = projector.diagonal();
  if (projector != diagonal) {
    const auto solver = symmetric_eigen(projector);
    vectors = solver.vectors;
    values = solver.values;
  }
  basis.axes.setZero();
  for (int k = 0; k < 3; ++k) {
    if (values[k] > 0.5) {
      basis.axes.col(basis.rank++) = vectors.col(k);
    }
  }
  return basis;
}

/// The matrix on the free directions, lower triangle by columns. The pattern
/// holds it by rows, so columns fill with ascending rows when rows are visited
/// in order.
class FreeMatrix {
 public:
  FreeMatrix(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
             const std::vector<int>& start, const std::vector<FreeBasis>& bases)
      : pattern_(pattern), matrix_(matrix), start_(start), bases_(bases) {}

  SparseMatrix build() const {
    const int n = start_.back();
    SparseMatrix A(n, n);
    int* first = A.outerIndexPtr();
    std::fill(first, first + n + 1, 0);
    visit([&](int, int column, double) { ++first[column + 1]; });
    for (int c = 0; c < n; ++c) {
      first[c + 1] += first[c];
    }
    A.resizeNonZeros(first[n]);
    std::vector<int> next(first, first + n);
    visit([&](int row, int column, double value) {
      A.innerIndexPtr()[next[column]] = row;
      A.valuePtr()[next[column]++] = value;
    });
    return A;
  }

 private:
  Mat3 turned(int i, int j, const double* block) const {
    return bases_[i].axes.transpose() * Eigen::Map<const RowMat3>(block) *
           bases_[j].axes;
  }

  template <class Entry>
  void visit(const Entry& entry) const {
    for (int i = 0; i < pattern_.nodes; ++i) {
      const int first = pattern_.start[i];
      const int count = pattern_.start[i + 1] - first;
      std::vector<Mat3> blocks;
      blocks.reserve(count + 1);
      for (int b = 0; b < count; ++b) {
        blocks.push_back(turned(i, pattern_.column[first + b],
                                matrix_.lower.data() + 9L * (first + b)));
      }
      blocks.push_back(turned(i, i, matrix_.diagonal.data() + 9L * i));
      for (int r = 0; r < bases_[i].rank; ++r) {
        for (int b = 0; b <= count; ++b) {
          const int j = b < count ? pattern_.column[first + b] : i;
          const int last = b < count ? bases_[j].rank : r + 1;
          for (int c = 0; c < last; ++c) {
            entry(start_[i] + r, start_[j] + c, blocks[b](r, c));
          }
        }
      }
    }
  }

  const BlockPattern& pattern_;
  const BlockMatrix<double>& matrix_;
  const std::vector<int>& start_;
  const std::vector<FreeBasis>& bases_;
};

}  // namespace

FreeUnknowns free_unknowns(const NodeFreedom& freedom, int nodes) {
  FreeUnknowns unknowns;
  unknowns.bases.resize(nodes);
  for (std::size_t h = 0; h < freedom.held.size(); ++h) {
    unknowns.bases[freedom.held[h]] = free_basis(freedom.projector[h]);
  }
  unknowns.start.assign(1, 0);
  for (const FreeBasis& basis : unknowns.bases) {
    unknowns.start.push_back(unknowns.start.back() + basis.rank);
  }
  return unknowns;
}

SparseMatrix free_matrix(const BlockPattern& pattern,
                         const BlockMatrix<double>& matrix,
                         const FreeUnknowns& unknowns) {
  return FreeMatrix(pattern, matrix, unknowns.start, unknowns.bases).build();
}

}  // namespace meniscus::solver
