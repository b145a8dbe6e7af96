/// Products of 3 x 3 blocks with K interleaved vectors (internal).
#pragma once

namespace meniscus {

/// t += A x, the block row-major.
template <int K, class Real>
inline void add_block(const Real* A, const Real* x, Real* t) {
  for (int r = 0; r < 3; ++r, A += 3) {
    for (int k = 0; k < K; ++k) {
      t[r * K + k] += A[0] * x[k] + A[1] * x[K + k] + A[2] * x[2 * K + k];
    }
  }
}

/// t += A^T x.
template <int K, class Real>
inline void add_block_transposed(const Real* A, const Real* x, Real* t) {
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < K; ++k) {
      t[c * K + k] +=
          A[c] * x[k] + A[3 + c] * x[K + k] + A[6 + c] * x[2 * K + k];
    }
  }
}

}  // namespace meniscus
