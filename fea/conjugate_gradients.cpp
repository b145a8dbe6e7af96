#include "fea/conjugate_gradients.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "fea/block_kernels.h"

namespace meniscus {

namespace {

using Vec = std::vector<double>;

template <int K>
using Sums = std::array<double, K>;

/// Nodes whose products are summed in one piece, whatever the threads.
constexpr int kPiece = 1024;

template <int K>
class Solver {
 public:
  explicit Solver(const CgProblem& problem)
      : problem_(problem), nodes_(problem.pattern.nodes) {}

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
      for (int i = 0; i < nodes_; ++i) {
        u[k].segment<3>(3L * i) = at(u_, i, k);
      }
    }
    return columns_;
  }

 private:
  static constexpr std::ptrdiff_t kWidth = K * kLanes<3>;
  using Node = Eigen::Array<double, kLanes<3>, 1>;

  static Eigen::Map<Vec3> at(Vec& v, int node, int k) {
    return Eigen::Map<Vec3>(v.data() + node * kWidth + k * kLanes<3>);
  }
  static Eigen::Map<Node> lane(Vec& v, int node, int k) {
    return Eigen::Map<Node>(v.data() + node * kWidth + k * kLanes<3>);
  }

  /// work(node, sums) for all nodes, `sums` added in pieces of fixed length.
  template <class Work>
  Sums<K> over_nodes(const Work& work) {
    const int pieces = (nodes_ + kPiece - 1) / kPiece;
    std::vector<Sums<K>> part(pieces);
#pragma omp parallel for schedule(static) if (nodes_ >= kParallelRows)
    for (int p = 0; p < pieces; ++p) {
      Sums<K> sum{};
      const int last = std::min(nodes_, (p + 1) * kPiece);
      for (int i = p * kPiece; i < last; ++i) {
        work(i, sum);
      }
      part[p] = sum;
    }
    Sums<K> total{};
    for (const Sums<K>& sum : part) {
      for (int k = 0; k < K; ++k) {
        total[k] += sum[k];
      }
    }
    return total;
  }

  Sums<K> dot(Vec& a, Vec& b) {
    return over_nodes([&](int i, Sums<K>& sum) {
      for (int k = 0; k < K; ++k) {
        sum[k] += at(a, i, k).dot(at(b, i, k));
      }
    });
  }

  /// Takes off what `v` has along held directions.
  void project(Vec& v) {
    const NodeFreedom& freedom = problem_.freedom;
    for (std::size_t h = 0; h < freedom.held.size(); ++h) {
      for (int k = 0; k < K; ++k) {
        auto vk = at(v, freedom.held[h], k);
        vk = (freedom.projector[h] * vk).eval();
      }
    }
  }

  void start(const std::vector<VectorX>& f, const std::vector<VectorX>& u) {
    for (Vec* v : {&u_, &r_, &z_, &p_, &q_}) {
      v->assign(static_cast<std::size_t>(nodes_) * kWidth, 0.0);
    }
    for (int i = 0; i < nodes_; ++i) {
      for (int k = 0; k < K; ++k) {
        at(r_, i, k) = f[k].segment<3>(3L * i);
        at(u_, i, k) = u[k].segment<3>(3L * i);
      }
    }
    project(r_);
    project(u_);
    load_ = dot(r_, r_);
    const bool zero_start =
        std::all_of(u_.begin(), u_.end(), [](double v) { return v == 0.0; });
    if (!zero_start) {
      multiply<3, K>(problem_.pattern, problem_.matrix, u_.data(), q_.data());
      over_nodes([&](int i, Sums<K>&) {
        for (int k = 0; k < K; ++k) {
          at(r_, i, k) -= at(q_, i, k);
        }
      });
      project(r_);
    }
    const Sums<K> rr = dot(r_, r_);
    columns_.resize(K);
    for (int k = 0; k < K; ++k) {
      live_[k] = true;
      ++open_;
      if (load_[k] == 0.0) {  // all load on held directions: stays at rest
        for (int i = 0; i < nodes_; ++i) {
          at(u_, i, k).setZero();
          at(r_, i, k).setZero();
        }
        close(k, CgEnd::Converged);
      } else {
        judge(k, rr[k]);
      }
    }
  }

  void iterate(int step) {
    problem_.preconditioner.apply(r_, z_, K);
    project(z_);  // it knows the base design's held directions
    const Sums<K> rz = dot(r_, z_);
    Sums<K> beta{};
    for (int k = 0; k < K; ++k) {
      beta[k] = step > 0 && live_[k] ? rz[k] / rz_[k] : 0.0;
    }
    rz_ = rz;
    over_nodes([&](int i, Sums<K>&) {
      for (int k = 0; k < K; ++k) {
        lane(p_, i, k) = lane(z_, i, k) + beta[k] * lane(p_, i, k);
      }
    });
    multiply<3, K>(problem_.pattern, problem_.matrix, p_.data(), q_.data());
    const Sums<K> pq = dot(p_, q_);
    Sums<K> alpha{};
    for (int k = 0; k < K; ++k) {
      if (live_[k] && !(std::isfinite(rz[k]) && std::isfinite(pq[k]))) {
        close(k, CgEnd::NotFinite);
      } else if (live_[k] && !(rz[k] > 0.0 && pq[k] > 0.0)) {
        close(k, CgEnd::NotPositive);
      }
      alpha[k] = live_[k] ? rz[k] / pq[k] : 0.0;
    }
    over_nodes([&](int i, Sums<K>&) {
      for (int k = 0; k < K; ++k) {
        lane(u_, i, k) += alpha[k] * lane(p_, i, k);
        at(r_, i, k) -= alpha[k] * at(q_, i, k);
      }
    });
    project(r_);
    const Sums<K> rr = dot(r_, r_);
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
  const int nodes_;
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
