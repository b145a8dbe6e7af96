#include "fea/solver/level_transfers.h"

#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

template <int B, int K>
void restrict_motions(const Prolongation& P, const float* upper,
                      float* coarse) {
  constexpr std::ptrdiff_t kFine = K * kLanes<B>;
  constexpr std::ptrdiff_t kCoarse = K * kLanes<6>;
  const int count = static_cast<int>(P.row_start.size()) - 1;
  const auto blocks = static_cast<int>(P.row.size());  // many an aggregate
#pragma omp parallel for schedule(static) if (blocks >= kParallelRows)
  for (int a = 0; a < count; ++a) {
    Lanes<float, 6> sum[K];
    for (Lanes<float, 6>& column : sum) {
      column.setZero();
    }
    for (int t = P.row_start[a]; t < P.row_start[a + 1]; ++t) {
      const float* block =
          P.row_value.data() + static_cast<std::ptrdiff_t>(6 * B) * t;
      const float* u = upper + P.row[t] * kFine;
      for (int k = 0; k < K; ++k) {
        for (int r = 0; r < B; ++r) {
          sum[k] -= lanes<6>(block + 6 * r) * u[k * kLanes<B> + r];
        }
      }
    }
    for (int k = 0; k < K; ++k) {
      lanes<6>(coarse + a * kCoarse + k * kLanes<6>) = sum[k];
    }
  }
}

template <int B, int K>
void prolong_motions(const Prolongation& P, const float* e, float* x) {
  constexpr std::ptrdiff_t kFine = K * kLanes<B>;
  constexpr std::ptrdiff_t kCoarse = K * kLanes<6>;
  const int count = static_cast<int>(P.start.size()) - 1;
#pragma omp parallel for schedule(static) if (count >= kParallelRows)
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < K; ++k) {
      for (int r = 0; r < B; ++r) {
        Lanes<float, 6> sum = Lanes<float, 6>::Zero();
        for (int b = P.start[i]; b < P.start[i + 1]; ++b) {
          sum += lanes<6>(P.value.data() +
                          static_cast<std::ptrdiff_t>(6 * B) * b + 6 * r) *
                 lanes<6>(e + P.column[b] * kCoarse + k * kLanes<6>);
        }
        x[i * kFine + k * kLanes<B> + r] += sum.sum();
      }
    }
  }
}

template <int K>
void restrict_corners(const CornerMap& map, float factor, const float* upper,
                      float* coarse) {
  using Node = Eigen::Array<float, 4 * K, 1>;
  const auto at = [&](int node) {
    return Eigen::Map<const Node>(upper +
                                  static_cast<std::ptrdiff_t>(4 * K) * node);
  };
  const int count = static_cast<int>(map.corner.size());
#pragma omp parallel for schedule(static) if (count >= kParallelRows)
  for (int c = 0; c < count; ++c) {
    Node mids = Node::Zero();
    for (int k = map.around_start[c]; k < map.around_start[c + 1]; ++k) {
      mids += at(map.around[k]);
    }
    Eigen::Map<Node>(coarse + static_cast<std::ptrdiff_t>(4 * K) * c) =
        -factor * (at(map.corner[c]) + 0.5F * mids);
  }
}

template <int K>
void prolong_corners(const CornerMap& map, const float* e, float* x) {
  using Node = Eigen::Array<float, 4 * K, 1>;
  const auto coarse = [&](int c) {
    return Eigen::Map<const Node>(e + static_cast<std::ptrdiff_t>(4 * K) * c);
  };
  const auto fine = [&](int node) {
    return Eigen::Map<Node>(x + static_cast<std::ptrdiff_t>(4 * K) * node);
  };
  const int corners = static_cast<int>(map.corner.size());
#pragma omp parallel for schedule(static) if (corners >= kParallelRows)
  for (int c = 0; c < corners; ++c) {
    fine(map.corner[c]) += coarse(c);
  }
  const int mids = static_cast<int>(map.mid.size());
#pragma omp parallel for schedule(static) if (mids >= kParallelRows)
  for (int m = 0; m < mids; ++m) {
    fine(map.mid[m]) +=
        0.5F * (coarse(map.ends[m][0]) + coarse(map.ends[m][1]));
  }
}
#define MENISCUS_TRANSFERS(K)                                              \
  template void restrict_motions<3, K>(const Prolongation&, const float*,  \
                                       float*);                            \
  template void restrict_motions<6, K>(const Prolongation&, const float*,  \
                                       float*);                            \
  template void prolong_motions<3, K>(const Prolongation&, const float*,   \
                                      float*);                             \
  template void prolong_motions<6, K>(const Prolongation&, const float*,   \
                                      float*);                             \
  template void restrict_corners<K>(const CornerMap&, float, const float*, \
                                    float*);                               \
  template void prolong_corners<K>(const CornerMap&, const float*, float*);
MENISCUS_TRANSFERS(1)
MENISCUS_TRANSFERS(2)
MENISCUS_TRANSFERS(3)
MENISCUS_TRANSFERS(4)
#undef MENISCUS_TRANSFERS

}  // namespace meniscus::solver
