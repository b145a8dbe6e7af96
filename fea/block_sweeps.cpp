#include "fea/block_sweeps.h"

#include <algorithm>

#include "fea/block_kernels.h"

namespace meniscus {

namespace {

/// One row: new x_i from r_i, the row's gathered part and `upper`_i, then the
/// scatter of x_i through the transposed blocks.
template <int K, bool Backward>
inline void relax_row(const SweepMatrix& matrix, int i, const float* r,
                      float* x, float* upper) {
  constexpr int kWidth = 3 * K;
  const BlockPattern& p = *matrix.pattern;
  const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * kWidth;
  float t[kWidth] = {};
  // Blocks in the order of the sweep, so that memory streams one way.
  const int first = p.start[i];
  const int last = p.start[i + 1];
  for (int n = 0; n < last - first; ++n) {
    const int k = Backward ? last - 1 - n : first + n;
    add_block<K>(matrix.lower + 9L * k, x + 1L * p.column[k] * kWidth, t);
  }
  for (int d = 0; d < kWidth; ++d) {
    t[d] = r[at + d] - t[d] - upper[at + d];
  }
  float xi[kWidth] = {};
  add_block<K>(matrix.inverse + 9L * i, t, xi);
  std::copy_n(xi, kWidth, x + at);
  for (int k = first; k < last; ++k) {
    add_block_transposed<K>(matrix.lower + 9L * k, xi,
                            upper + 1L * p.column[k] * kWidth);
  }
}

}  // namespace

template <int K>
void sweep_forward(const SweepMatrix& matrix, const float* r, float* x,
                   float* upper) {
  for (int i = 0; i < matrix.pattern->nodes; ++i) {
    relax_row<K, false>(matrix, i, r, x, upper);
    // This row has used the old sum; rows below now add the new one.
    float* sum = upper + 3L * K * i;
    for (int d = 0; d < 3 * K; ++d) {
      sum[d] = -sum[d];
    }
  }
}

template <int K>
void sweep_backward(const SweepMatrix& matrix, const float* r, float* x,
                    float* upper) {
  for (int i = matrix.pattern->nodes - 1; i >= 0; --i) {
    relax_row<K, true>(matrix, i, r, x, upper);
  }
}

#define MENISCUS_SWEEPS(K)                                                  \
  template void sweep_forward<K>(const SweepMatrix&, const float*, float*,  \
                                 float*);                                   \
  template void sweep_backward<K>(const SweepMatrix&, const float*, float*, \
                                  float*);
MENISCUS_SWEEPS(1)
MENISCUS_SWEEPS(2)
MENISCUS_SWEEPS(3)
MENISCUS_SWEEPS(4)
#undef MENISCUS_SWEEPS

}  // namespace meniscus
