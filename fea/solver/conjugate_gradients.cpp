#include "fea/solver/conjugate_gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/operation_count.h"
#include "fea/solver/block_kernels.h"

namespace meniscus::solver {

namespace {

using Vec = std::vector<double>;

template <int K>
using Sums = std::array<double, K>;

/// Nodes whose products are summed in one piece, whatever the threads.
constexpr int kRowsPerPiece = 1024;
/// Operations of a step on a node's vectors: two products, three sums.
constexpr double kVectorWork = 5 * 2 * 3;

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
    const int pieces = (nodes_ + kRowsPerPiece - 1) / kRowsPerPiece;
    std::vector<Sums<K>> part(pieces);
#pragma omp parallel for schedule(static) if (nodes_ >= kParallelRows)
    for (int p = 0; p < pieces; ++p) {
      Sums<K> sum{};
      const int last = std::min(nodes_, (p + 1) * kRowsPerPiece);
      for (int i = p * kRowsPerPiece; i < last; ++i) {
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
    const Sums<K> load = dot(r_, r_);
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
    // Of the solution: u . A u + 2 u . r + (error) . A (error), the last of
    // which the steps add up (Hestenes, Stiefel 1952).
    const Sums<K> uq = dot(u_, q_);
    const Sums<K> ur = dot(u_, r_);
    columns_.resize(K);
    for (int k = 0; k < K; ++k) {
      live_[k] = true;
      ++open_;
      energy_[k] = uq[k] + 2.0 * ur[k];
      if (load[k] == 0.0) {  // all load on held directions: stays at rest
        for (int i = 0; i < nodes_; ++i) {
          at(u_, i, k).setZero();
          at(r_, i, k).setZero();
        }
        close(k, CgEnd::Converged);
      }
    }
  }

  void iterate(int step) {
    problem_.preconditioner.apply(r_, z_, K);
    project(z_);  // it knows the base design's held directions
    const Sums<K> rz = dot(r_, z_);
    check_residual(step, rz);
    if (open_ == 0) {
      return;
    }
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
    count_operations(kVectorWork * K * nodes_);
    multiply<3, K>(problem_.pattern, problem_.matrix, p_.data(), q_.data());
    const Sums<K> pq = dot(p_, q_);
    Sums<K> alpha{};
    for (int k = 0; k < K; ++k) {
      if (live_[k] && !std::isfinite(pq[k])) {
        close(k, CgEnd::NotFinite);
      } else if (live_[k] && !(pq[k] > 0.0)) {
        close(k, CgEnd::NotPositive);
      }
      alpha[k] = live_[k] ? rz[k] / pq[k] : 0.0;
      energy_[k] += alpha[k] * rz[k];
    }
    over_nodes([&](int i, Sums<K>&) {
      for (int k = 0; k < K; ++k) {
        lane(u_, i, k) += alpha[k] * lane(p_, i, k);
        at(r_, i, k) -= alpha[k] * at(q_, i, k);
      }
    });
    project(r_);
    problem_.monitor.progress(
        {.stage = "fea",
         .detail = std::isfinite(columns_[0].error)
                       ? fmt::format("step {}, error {:.1e}", step + 1,
                                     columns_[0].error)
                       : fmt::format("step {}", step + 1)});
  }

  /// Ends columns that have arrived or cannot go on.
  void check_residual(int step, const Sums<K>& rz) {
    for (int k = 0; k < K; ++k) {
      if (!live_[k]) {
        continue;
      }
      CgColumn& column = columns_[k];
      column.iterations = step;
      const bool started = energy_[k] > 0.0;
      column.error = started && rz[k] >= 0.0
                         ? std::sqrt(rz[k] / energy_[k])
                         : std::numeric_limits<double>::infinity();
      if (!std::isfinite(rz[k])) {
        close(k, CgEnd::NotFinite);
      } else if (column.error <= problem_.tolerance) {
        // M r is at hand, and is most of what is missing. A start that serves
        // is left as it is: the same design again gives the same bits.
        for (int i = 0; i < nodes_ && step > 0; ++i) {
          at(u_, i, k) += at(z_, i, k);
        }
        close(k, CgEnd::Converged);
      } else if (!(rz[k] > 0.0)) {
        close(k, CgEnd::NotPositive);
      }
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
  Sums<K> energy_{};  // u . A u of the solution, as far as known
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

}  // namespace meniscus::solver
