#include "fea/block_sweeps.h"

#include "fea/block_kernels.h"

namespace meniscus {

namespace {

/// One row: new x_i from r_i, the row's gathered part and `upper`_i.
template <int B, int K, bool Backward>
inline void relax_row(const SweepMatrix& matrix, int i, const float* r,
                      float* x, const float* upper) {
  constexpr int kLane = kLanes<B>;
  constexpr std::ptrdiff_t kWidth = K * kLane;
  const BlockPattern& p = *matrix.pattern;
  RowSum<B, K, float> sum;
  // Blocks in the order of the sweep, so that memory streams one way.
  const int first = p.start[i];
  const int last = p.start[i + 1];
  for (int n = 0; n < last - first; ++n) {
    const int k = Backward ? last - 1 - n : first + n;
    sum.add(matrix.lower + static_cast<std::ptrdiff_t>(B * B) * k,
            x + p.column[k] * kWidth);
  }
  const float* inverse =
      matrix.inverse + static_cast<std::ptrdiff_t>(B * kLane) * i;
  for (int k = 0; k < K; ++k) {
    const std::ptrdiff_t at = i * kWidth + k * kLane;
    Lanes<float, B> xi = Lanes<float, B>::Zero();
    for (int c = 0; c < B; ++c) {
      xi += lanes<B>(inverse + c * kLane) *
            (r[at + c] - sum.component(k, c) - upper[at + c]);
    }
    lanes<B>(x + at) = xi;
  }
}

/// upper += the transposed blocks of row i times x_i.
template <int B, int K>
inline void scatter_row(const SweepMatrix& matrix, int i, const float* x,
                        float* upper) {
  constexpr std::ptrdiff_t kWidth = K * kLanes<B>;
  const BlockPattern& p = *matrix.pattern;
  for (int k = p.start[i]; k < p.start[i + 1]; ++k) {
    add_transposed<B, K>(matrix.lower + static_cast<std::ptrdiff_t>(B * B) * k,
                         x + i * kWidth, upper + p.column[k] * kWidth);
  }
}

}  // namespace

template <int B, int K>
void sweep_forward(const SweepMatrix& matrix, const float* r, float* x,
                   float* upper) {
  const RowChunks& chunks = matrix.pattern->chunks;
  over_chunks(chunks, RowOrder::Forward, [&](int chunk) {
    for (int i = chunks.first[chunk]; i < chunks.first[chunk + 1]; ++i) {
      relax_row<B, K, false>(matrix, i, r, x, upper);
      // This row has used the old sum; rows below now add the new one.
      constexpr std::ptrdiff_t kWidth = K * kLanes<B>;
      Eigen::Map<Eigen::Array<float, kWidth, 1>> sum(upper + i * kWidth);
      sum = -sum;
      scatter_row<B, K>(matrix, i, x, upper);
    }
  });
}

template <int B, int K>
void sweep_backward(const SweepMatrix& matrix, const float* r, float* x,
                    float* upper) {
  const RowChunks& chunks = matrix.pattern->chunks;
  over_chunks(chunks, RowOrder::Backward, [&](int chunk) {
    for (int i = chunks.first[chunk + 1] - 1; i >= chunks.first[chunk]; --i) {
      relax_row<B, K, true>(matrix, i, r, x, upper);
      scatter_row<B, K>(matrix, i, x, upper);
    }
  });
}

#define MENISCUS_SWEEPS(B, K)                                                  \
  template void sweep_forward<B, K>(const SweepMatrix&, const float*, float*,  \
                                    float*);                                   \
  template void sweep_backward<B, K>(const SweepMatrix&, const float*, float*, \
                                     float*);
MENISCUS_SWEEPS(3, 1)
MENISCUS_SWEEPS(3, 2)
MENISCUS_SWEEPS(3, 3)
MENISCUS_SWEEPS(3, 4)
MENISCUS_SWEEPS(6, 1)
MENISCUS_SWEEPS(6, 2)
MENISCUS_SWEEPS(6, 3)
MENISCUS_SWEEPS(6, 4)
#undef MENISCUS_SWEEPS

}  // namespace meniscus
