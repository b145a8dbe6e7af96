#include "fea/preconditioner.h"

#include <algorithm>

#include <Eigen/LU>

#include "fea/block_sweeps.h"
#include "fea/free_factor.h"

namespace meniscus {

namespace {

class Direct final : public Preconditioner {
 public:
  Direct(const BlockPattern& pattern, const BlockMatrix<double>& matrix,
         const std::vector<char>& fixed)
      : factor_(pattern, matrix, fixed) {}

  void apply(const std::vector<double>& r, std::vector<double>& z,
             int K) const override {
    std::fill(z.begin(), z.end(), 0.0);
    factor_.solve(r.data(), z.data(), K);
  }

 private:
  FreeFactor factor_;
};

/// Fixed flags of the corner nodes.
std::vector<char> coarse_fixed(const MultigridInput& input) {
  std::vector<char> fixed;
  fixed.reserve(3 * input.map->corner.size());
  for (const int node : input.map->corner) {
    for (int k = 0; k < 3; ++k) {
      fixed.push_back((*input.fixed)[3L * node + k]);
    }
  }
  return fixed;
}

/// Inverses of the diagonal blocks on their free components, zero elsewhere.
std::vector<float> inverse_diagonal(const MultigridInput& input) {
  const int nodes = input.pattern->nodes;
  std::vector<float> inverse(9L * nodes);
  for (int i = 0; i < nodes; ++i) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> D =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
            input.matrix->diagonal.data() + 9L * i) /
        input.smoother->scale;
    const char* fixed = input.fixed->data() + 3L * i;
    for (int k = 0; k < 3; ++k) {
      if (fixed[k] != 0) {
        D.row(k).setZero();
        D.col(k).setZero();
        D(k, k) = 1.0;
      }
    }
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> I = D.inverse();
    for (int k = 0; k < 3; ++k) {
      if (fixed[k] != 0) {
        I(k, k) = 0.0;
      }
    }
    for (int k = 0; k < 9; ++k) {
      inverse[9L * i + k] = static_cast<float>(I.data()[k]);
    }
  }
  return inverse;
}

class Multigrid final : public Preconditioner {
 public:
  explicit Multigrid(const MultigridInput& input)
      : pattern_(*input.pattern),
        smoother_(*input.smoother),
        map_(*input.map),
        fixed_(*input.fixed),
        inverse_(inverse_diagonal(input)),
        coarse_(*input.coarse_pattern, *input.coarse_matrix,
                coarse_fixed(input)) {}

  void apply(const std::vector<double>& r, std::vector<double>& z,
             int K) const override {
    switch (K) {
      case 1:
        return cycle<1>(r, z);
      case 2:
        return cycle<2>(r, z);
      case 3:
        return cycle<3>(r, z);
      default:
        return cycle<4>(r, z);
    }
  }

 private:
  template <int K>
  void cycle(const std::vector<double>& r, std::vector<double>& z) const {
    const std::size_t size = r.size();
    double largest = 0.0;
    for (std::size_t d = 0; d < size; ++d) {
      largest = std::max(largest, std::abs(r[d]));
    }
    if (!(largest > 0.0)) {
      std::fill(z.begin(), z.end(), 0.0);
      return;
    }
    // Scaled so that single precision neither overflows nor underflows.
    std::vector<float> right(size);
    std::vector<float> x(size, 0.0F);
    std::vector<float> upper(size, 0.0F);
    for (std::size_t d = 0; d < size; ++d) {
      right[d] = static_cast<float>(r[d] / largest);
    }
    const SweepMatrix matrix{&pattern_, smoother_.lower.data(),
                             inverse_.data()};
    // Down and up before and after: 18 iterations where one sweep each way
    // takes 23, and the coarse solve costs as much as four sweeps.
    sweep_backward<K>(matrix, right.data(), x.data(), upper.data());
    sweep_forward<K>(matrix, right.data(), x.data(), upper.data());
    correct<K>(upper, x);
    std::fill(upper.begin(), upper.end(), 0.0F);
    sweep_backward<K>(matrix, right.data(), x.data(), upper.data());
    sweep_forward<K>(matrix, right.data(), x.data(), upper.data());
    const double scale = largest / smoother_.scale;
    for (std::size_t d = 0; d < size; ++d) {
      z[d] = scale * x[d];
    }
  }

  /// Adds the coarse correction of the residual, which is -upper.
  template <int K>
  void correct(const std::vector<float>& upper, std::vector<float>& x) const {
    constexpr int kWidth = 3 * K;
    const std::size_t coarse_size = kWidth * map_.corner.size();
    std::vector<double> right(coarse_size);
    std::vector<double> e(coarse_size, 0.0);
    const auto residual = [&](int node, int d) {
      return fixed_[3L * node + d / K] != 0
                 ? 0.0
                 : -static_cast<double>(upper[1L * kWidth * node + d]);
    };
    for (std::size_t c = 0; c < map_.corner.size(); ++c) {
      for (int d = 0; d < kWidth; ++d) {
        right[kWidth * c + d] = residual(map_.corner[c], d);
      }
    }
    for (std::size_t m = 0; m < map_.mid.size(); ++m) {
      for (int d = 0; d < kWidth; ++d) {
        const double half = 0.5 * residual(map_.mid[m], d);
        right[1L * kWidth * map_.ends[m][0] + d] += half;
        right[1L * kWidth * map_.ends[m][1] + d] += half;
      }
    }
    coarse_.solve(right.data(), e.data(), K);
    const double scale = smoother_.scale;
    for (std::size_t c = 0; c < map_.corner.size(); ++c) {
      for (int d = 0; d < kWidth; ++d) {
        e[kWidth * c + d] *= scale;
        x[1L * kWidth * map_.corner[c] + d] +=
            static_cast<float>(e[kWidth * c + d]);
      }
    }
    for (std::size_t m = 0; m < map_.mid.size(); ++m) {
      const int node = map_.mid[m];
      for (int d = 0; d < kWidth; ++d) {
        if (fixed_[3L * node + d / K] == 0) {
          x[1L * kWidth * node + d] +=
              static_cast<float>(0.5 * (e[1L * kWidth * map_.ends[m][0] + d] +
                                        e[1L * kWidth * map_.ends[m][1] + d]));
        }
      }
    }
  }

  const BlockPattern& pattern_;
  const SmootherMatrix& smoother_;
  const CornerMap& map_;
  std::vector<char> fixed_;
  std::vector<float> inverse_;
  FreeFactor coarse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_direct(const BlockPattern& pattern,
                                            const BlockMatrix<double>& matrix,
                                            const std::vector<char>& fixed) {
  return std::make_unique<Direct>(pattern, matrix, fixed);
}

std::unique_ptr<Preconditioner> make_multigrid(const MultigridInput& input) {
  return std::make_unique<Multigrid>(input);
}

SmootherMatrix make_smoother_matrix(const BlockMatrix<double>& matrix) {
  SmootherMatrix result;
  result.scale =
      *std::max_element(matrix.diagonal.begin(), matrix.diagonal.end());
  const double factor = 1.0 / result.scale;
  result.lower.reserve(matrix.lower.size());
  for (const double value : matrix.lower) {
    result.lower.push_back(static_cast<float>(factor * value));
  }
  return result;
}

}  // namespace meniscus
