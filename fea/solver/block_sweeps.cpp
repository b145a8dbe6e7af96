#include "fea/solver/block_sweeps.h"

#include <algorithm>

#include "core/operation_count.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

/// One row: new x_i from r_i, the row's gathered part and, backward, `upper`_i.
template <int B, int K, bool Backward>
inline void relax_row(const SweepMatrix& matrix, int i, const float* r,
                      float* x, const float* upper) {
  constexpr int kLane = kLanes<B>;
  constexpr std::ptrdiff_t kWidth = K * kLane;
  const BlockPattern& p = *matrix.pattern;
  // Two sums, so that one addition need not wait for the last.
  RowSum<B, K, float> sum;
  RowSum<B, K, float> odd;
  const auto add = [&](RowSum<B, K, float>& to, int k) {
    to.add(matrix.lower + static_cast<std::ptrdiff_t>(B * B) * k,
           x + p.column[k] * kWidth);
  };
  // Blocks in the order of the sweep, so that memory streams one way.
  const int count = p.start[i + 1] - p.start[i];
  const int first = Backward ? p.start[i + 1] - 1 : p.start[i];
  constexpr int kStep = Backward ? -1 : 1;
  for (int n = 0; n + 1 < count; n += 2) {
    add(sum, first + kStep * n);
    add(odd, first + kStep * (n + 1));
  }
  if (count % 2 != 0) {
    add(sum, first + kStep * (count - 1));
  }
  sum.add(odd);
  const float* inverse =
      matrix.inverse + static_cast<std::ptrdiff_t>(B * kLane) * i;
  for (int k = 0; k < K; ++k) {
    const std::ptrdiff_t at = i * kWidth + k * kLane;
    Lanes<float, B> xi = Lanes<float, B>::Zero();
    for (int c = 0; c < B; ++c) {
      float left = r[at + c] - sum.component(k, c);
      if constexpr (Backward) {
        left -= upper[at + c];
      }
      xi += lanes<B>(inverse + c * kLane) * left;
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
  const Spread<B, K, float> xi(x + i * kWidth);
  const int last = p.start[i + 1];
  const int* column = p.column.data();
  const float* block =
      matrix.lower + static_cast<std::ptrdiff_t>(B * B) * p.start[i];
  for (int k = p.start[i]; k < last; ++k, block += B * B) {
    xi.add_transposed(block, upper + column[k] * kWidth);
  }
}

/// Of a sweep: each block below the diagonal gathers and scatters; `terms`
/// beside the sum are taken off the right-hand side.
template <int B, int K>
double sweep_work(const BlockPattern& pattern, int terms) {
  return K * (4.0 * B * B * std::ssize(pattern.column) +
              (2.0 * B * B + 1.0 * B * terms) * pattern.nodes);
}

}  // namespace

template <int B, int K>
void sweep_forward(const SweepMatrix& matrix, const float* r, float* x,
                   float* upper) {
  const RowChunks& chunks = matrix.pattern->chunks;
  count_operations(sweep_work<B, K>(*matrix.pattern, 1));
  over_chunks(chunks, RowOrder::Forward, [&](int chunk) {
    for (int i = chunks.first[chunk]; i < chunks.first[chunk + 1]; ++i) {
      relax_row<B, K, false>(matrix, i, r, x, upper);
      constexpr std::ptrdiff_t kWidth = K * kLanes<B>;
      std::fill_n(upper + i * kWidth, kWidth, 0.0F);  // rows below add to it
      scatter_row<B, K>(matrix, i, x, upper);
    }
  });
}

template <int B, int K>
void sweep_backward(const SweepMatrix& matrix, const float* r, float* x,
                    float* upper) {
  const RowChunks& chunks = matrix.pattern->chunks;
  count_operations(sweep_work<B, K>(*matrix.pattern, 2));
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

}  // namespace meniscus::solver
