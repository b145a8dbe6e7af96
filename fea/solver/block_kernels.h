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

namespace meniscus::solver {

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

  void add(const RowSum& other) {
    for (int k = 0; k < K; ++k) {
      for (int r = 0; r < B; ++r) {
        partial[k][r] += other.partial[k][r];
      }
    }
  }

  Real component(int k, int r) const { return partial[k][r].sum(); }
};

/// The components of a node's x, each in all lanes: held in registers, where a
/// store to y would make the compiler read them anew.
template <int B, int K, class Real>
struct Spread {
  Lanes<Real, B> component[K][B];

  explicit Spread(const Real* x) {
    for (int k = 0; k < K; ++k) {
      for (int r = 0; r < B; ++r) {
        component[k][r].setConstant(x[k * kLanes<B> + r]);
      }
    }
  }

  /// y += A^T x.
  void add_transposed(const Real* A, Real* y) const {
    for (int k = 0; k < K; ++k) {
      Lanes<Real, B> sum = lanes<B>(y + k * kLanes<B>);
      for (int r = 0; r < B; ++r) {
        sum += lanes<B>(A + B * r) * component[k][r];
      }
      lanes<B>(y + k * kLanes<B>) = sum;
    }
  }
};

}  // namespace meniscus::solver
