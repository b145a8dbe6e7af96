/// Products of B x B blocks with padded vectors (internal).
///
/// A vector holds kLanes<B> numbers a node and column: its B components, then
/// padding. Blocks are dense row-major arrays; a row is read as kLanes<B>
/// numbers, the last of which belong to the next row or block. They meet the
/// padding of x, which must be zero, or end in the padding of y, which is
/// garbage afterwards. Arrays of blocks therefore end with kBlockPadding
/// numbers more.
#pragma once

#include <Eigen/Core>

namespace meniscus {

template <int B>
inline constexpr int kLanes = B <= 4 ? 4 : 8;
inline constexpr int kBlockPadding = 2;

template <class Real, int B>
using Lanes = Eigen::Array<Real, kLanes<B>, 1>;

template <int B, class Real>
inline Eigen::Map<const Lanes<Real, B>> lanes(const Real* p) {
  return Eigen::Map<const Lanes<Real, B>>(p);
}

template <int B, class Real>
inline Eigen::Map<Lanes<Real, B>> lanes(Real* p) {
  return Eigen::Map<Lanes<Real, B>>(p);
}

/// A block row times K columns, lane by lane: the sums over lanes are taken
/// once, at the end of the row.
template <int B, int K, class Real>
struct RowSum {
  Lanes<Real, B> partial[K][B];

  RowSum() {
    for (auto& column : partial) {
      for (auto& row : column) {
        row.setZero();
      }
    }
  }

  /// += A x.
  void add(const Real* A, const Real* x) {
    for (int r = 0; r < B; ++r) {
      const Lanes<Real, B> row = lanes<B>(A + B * r);
      for (int k = 0; k < K; ++k) {
        partial[k][r] += row * lanes<B>(x + k * kLanes<B>);
      }
    }
  }

  Real component(int k, int r) const { return partial[k][r].sum(); }
};

/// y += A^T x.
template <int B, int K, class Real>
inline void add_transposed(const Real* A, const Real* x, Real* y) {
  for (int k = 0; k < K; ++k) {
    const Real* xk = x + k * kLanes<B>;
    Lanes<Real, B> sum = lanes<B>(y + k * kLanes<B>);
    for (int r = 0; r < B; ++r) {
      sum += lanes<B>(A + B * r) * xk[r];
    }
    lanes<B>(y + k * kLanes<B>) = sum;
  }
}

}  // namespace meniscus
