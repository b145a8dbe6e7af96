#include "fea/conjugate_gradients.h"

#include <cmath>

#include <fmt/format.h>

namespace meniscus {

namespace {

using Vec = std::vector<double>;

template <int K>
using Sums = std::array<double, K>;

/// Dot products of interleaved vectors, summed in pieces of fixed length.
template <int K>
Sums<K> dot(const Vec& a, const Vec& b) {
  constexpr std::size_t kWidth = K;
  constexpr std::size_t kPiece = 4096 * kWidth;
  Sums<K> total{};
  for (std::size_t first = 0; first < a.size(); first += kPiece) {
    const std::size_t last = std::min(first + kPiece, a.size());
    double sum[4][K] = {};  // four chains hide the latency of additions
    std::size_t d = first;
    for (; d + 4 * kWidth <= last; d += 4 * kWidth) {
      for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t k = 0; k < kWidth; ++k) {
          sum[c][k] += a[d + c * kWidth + k] * b[d + c * kWidth + k];
        }
      }
    }
    for (; d < last; d += K) {
      for (int k = 0; k < K; ++k) {
        sum[0][k] += a[d + k] * b[d + k];
      }
    }
    for (int k = 0; k < K; ++k) {
      total[k] += (sum[0][k] + sum[1][k]) + (sum[2][k] + sum[3][k]);
    }
  }
  return total;
}

template <int K>
class Solver {
 public:
  explicit Solver(const CgProblem& problem) : problem_(problem) {}

  std::vector<CgColumn> run(const std::vector<VectorX>& f,
                            std::vector<VectorX>& u) {
    start(f, u);
    for (int step = 0; step < problem_.max_iterations && open_ > 0; ++step) {
      throw_if_stopped(problem_.monitor, "fea");
      iterate(step);
    }
    for (int k = 0; k < K; ++k) {
      if (live_[k]) {
        columns_[k].end = CgEnd::TooManyIterations;
      }
      for (std::size_t d = 0; d < size_; ++d) {
        u[k][static_cast<Eigen::Index>(d)] = u_[d * K + k];
      }
    }
    return columns_;
  }

 private:
  void start(const std::vector<VectorX>& f, const std::vector<VectorX>& u) {
    size_ = problem_.fixed.size();
    for (Vec* v : {&u_, &r_, &z_, &p_, &q_}) {
      v->assign(size_ * K, 0.0);
    }
    bool zero_start = true;
    for (std::size_t d = 0; d < size_; ++d) {
      for (int k = 0; k < K && problem_.fixed[d] == 0; ++k) {
        r_[d * K + k] = f[k][static_cast<Eigen::Index>(d)];
        u_[d * K + k] = u[k][static_cast<Eigen::Index>(d)];
        zero_start = zero_start && u_[d * K + k] == 0.0;
      }
    }
    load_ = dot<K>(r_, r_);
    if (!zero_start) {
      multiply<K>(problem_.pattern, problem_.matrix, u_.data(), q_.data());
      for (std::size_t d = 0; d < size_; ++d) {
        for (int k = 0; k < K && problem_.fixed[d] == 0; ++k) {
          r_[d * K + k] -= q_[d * K + k];
        }
      }
    }
    const Sums<K> rr = dot<K>(r_, r_);
    columns_.resize(K);
    for (int k = 0; k < K; ++k) {
      live_[k] = true;
      ++open_;
      if (load_[k] == 0.0) {  // all load on fixed components: stays at rest
        for (std::size_t d = 0; d < size_; ++d) {
          u_[d * K + k] = 0.0;
          r_[d * K + k] = 0.0;
        }
        close(k, CgEnd::Converged);
      } else {
        judge(k, rr[k]);
      }
    }
  }

  void iterate(int step) {
    problem_.preconditioner.apply(r_, z_, K);
    const Sums<K> rz = dot<K>(r_, z_);
    Sums<K> beta{};
    for (int k = 0; k < K; ++k) {
      beta[k] = step > 0 && live_[k] ? rz[k] / rz_[k] : 0.0;
    }
    rz_ = rz;
    for (std::size_t d = 0; d < size_; ++d) {
      for (int k = 0; k < K; ++k) {
        p_[d * K + k] = z_[d * K + k] + beta[k] * p_[d * K + k];
      }
    }
    multiply<K>(problem_.pattern, problem_.matrix, p_.data(), q_.data());
    const Sums<K> pq = dot<K>(p_, q_);
    Sums<K> alpha{};
    for (int k = 0; k < K; ++k) {
      if (live_[k] && !(std::isfinite(rz[k]) && std::isfinite(pq[k]))) {
        close(k, CgEnd::NotFinite);
      } else if (live_[k] && !(rz[k] > 0.0 && pq[k] > 0.0)) {
        close(k, CgEnd::NotPositive);
      }
      alpha[k] = live_[k] ? rz[k] / pq[k] : 0.0;
    }
    for (std::size_t d = 0; d < size_; ++d) {
      const double free = problem_.fixed[d] == 0 ? 1.0 : 0.0;
      for (int k = 0; k < K; ++k) {
        u_[d * K + k] += alpha[k] * p_[d * K + k];
        r_[d * K + k] -= free * alpha[k] * q_[d * K + k];
      }
    }
    const Sums<K> rr = dot<K>(r_, r_);
    for (int k = 0; k < K; ++k) {
      if (live_[k]) {
        columns_[k].iterations = step + 1;
        judge(k, rr[k]);
      }
    }
    problem_.monitor.progress(
        {.stage = "fea",
         .detail = fmt::format("step {}, residual {:.1e}", step + 1,
                               columns_[0].residual)});
  }

  void judge(int k, double rr) {
    columns_[k].residual = std::sqrt(rr / load_[k]);
    if (!std::isfinite(columns_[k].residual)) {
      close(k, CgEnd::NotFinite);
    } else if (columns_[k].residual <= problem_.tolerance) {
      close(k, CgEnd::Converged);
    }
  }

  void close(int k, CgEnd end) {
    columns_[k].end = end;
    live_[k] = false;
    --open_;
  }

  const CgProblem& problem_;
  std::size_t size_ = 0;
  Vec u_, r_, z_, p_, q_;
  Sums<K> load_{};
  Sums<K> rz_{};
  std::array<bool, K> live_{};
  int open_ = 0;
  std::vector<CgColumn> columns_;
};

}  // namespace

std::vector<CgColumn> conjugate_gradients(const CgProblem& problem,
                                          const std::vector<VectorX>& f,
                                          std::vector<VectorX>& u) {
  switch (f.size()) {
    case 1:
      return Solver<1>(problem).run(f, u);
    case 2:
      return Solver<2>(problem).run(f, u);
    case 3:
      return Solver<3>(problem).run(f, u);
    default:
      return Solver<4>(problem).run(f, u);
  }
}

}  // namespace meniscus
