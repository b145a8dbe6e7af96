#include "fea/solver/multigrid.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.h"
#include "core/math/linear_solve.h"
#include "fea/solver/block_kernels.h"
#include "fea/solver/block_sweeps.h"
#include "fea/solver/chebyshev.h"
#include "fea/solver/level_setup.h"
#include "fea/solver/level_transfers.h"
#include "fea/solver/smoothed_aggregation.h"

namespace meniscus::solver {

namespace {

/// Up to this many unknowns a level is solved by its Cholesky factor.
constexpr int kDirectUnknowns = 1500;
/// Below ten-node elements cycles cost little: as many as reduce every error
/// to this, by Chebyshev's iteration, are done for one on the finest level.
constexpr double kNodalReduction = 0.5;
constexpr int kMostNodalCycles = 6;
/// Of Lanczos' process for the lowest eigenvalue of such a cycle, and what the
/// highest is over 1, its bound without rounding.
constexpr int kLanczosSteps = 12;
constexpr double kHighest = 1.02;

/// A vector of a level, as block_sweeps.h has them; not set when made.
using LevelVector = Eigen::ArrayXf;

/// work(d) for all of a level vector's numbers.
template <class Work>
void over_numbers(Eigen::Index count, const Work& work) {
#pragma omp parallel for schedule(static) if (count >= kParallelRows)
  for (Eigen::Index d = 0; d < count; ++d) {
    work(d);
  }
}

/// A level's smoother.
struct Level {
  int block = 3;
  const BlockPattern* pattern = nullptr;
  const float* lower = nullptr;
  std::vector<float> inverse;

  Eigen::Index size(int K) const {
    return static_cast<Eigen::Index>(K) *
           (block == 3 ? kLanes<3> : kLanes<6>)*pattern->nodes;
  }
};

template <int K>
void forward(const Level& level, const float* r, float* x, float* upper) {
  const SweepMatrix m{level.pattern, level.lower, level.inverse.data()};
  level.block == 3 ? sweep_forward<3, K>(m, r, x, upper)
                   : sweep_forward<6, K>(m, r, x, upper);
}

template <int K>
void backward(const Level& level, const float* r, float* x, float* upper) {
  const SweepMatrix m{level.pattern, level.lower, level.inverse.data()};
  level.block == 3 ? sweep_backward<3, K>(m, r, x, upper)
                   : sweep_backward<6, K>(m, r, x, upper);
}

/// The free directions in single precision.
struct HeldNodes {
  std::vector<int> node;
  std::vector<Eigen::Matrix3f> projector;

  explicit HeldNodes(const NodeFreedom& freedom) : node(freedom.held) {
    for (const Mat3& P : freedom.projector) {
      projector.push_back(P.cast<float>());
    }
  }
  template <int K>
  void apply(float* x) const {
    for (std::size_t h = 0; h < node.size(); ++h) {
      for (int k = 0; k < K; ++k) {
        Eigen::Map<Eigen::Vector3f> v(
            x + (static_cast<std::ptrdiff_t>(node[h]) * K + k) * 4);
        v = (projector[h] * v).eval();
      }
    }
  }
};

class Multigrid final : public Preconditioner {
 public:
  explicit Multigrid(const MultigridInput& input)
      : map_(input.map),
        fine_held_(*input.freedom),
        nodal_freedom_(map_ != nullptr ? corner_freedom(*input.freedom, *map_)
                                       : *input.freedom),
        nodal_held_(nodal_freedom_) {
    if (map_ != nullptr) {
      scale_ = input.fine_smoother->scale;
      levels_.push_back({3, input.fine_pattern,
                         input.fine_smoother->lower.data(),
                         padded<3>(inverse_blocks(*input.fine_matrix, scale_,
                                                  *input.freedom))});
      nodal_factor_ = static_cast<float>(scale_ / input.nodal.smoother->scale);
    } else {
      scale_ = input.nodal.smoother->scale;
    }
    build(input.nodal);
    if (map_ != nullptr) {
      accelerate_nodal(input.nodal);
    }
  }

  void apply(const std::vector<double>& r, std::vector<double>& z,
             int K) const override {
    switch (K) {
      case 1:
        return run<1>(r, z);
      case 2:
        return run<2>(r, z);
      case 3:
        return run<3>(r, z);
      default:
        return run<4>(r, z);
    }
  }

 private:
  int nodal_at() const { return map_ != nullptr ? 1 : 0; }

  void build(const NodalLevel& nodal) {
    std::vector<double> inverse =
        inverse_blocks(*nodal.matrix, nodal.smoother->scale, nodal_freedom_);
    levels_.push_back(
        {3, nodal.pattern, nodal.smoother->lower.data(), padded<3>(inverse)});
    // A copy in the smoother's scale, so that all coarser levels have it.
    BlockMatrix<double> scaled = *nodal.matrix;
    for (auto* values : {&scaled.diagonal, &scaled.lower}) {
      for (double& value : *values) {
        value /= nodal.smoother->scale;
      }
    }
    const std::vector<double> motions = rigid_motions(*nodal.x, nodal_freedom_);
    AggregateLevel next =
        aggregate<3>({nodal.pattern, &scaled, &inverse, &motions});
    while (true) {
      own_.push_back(std::make_unique<OwnLevel>());
      OwnLevel& own = *own_.back();
      own.prolongation = std::move(next.prolongation);
      own.pattern = std::move(next.coarse.pattern);
      const BlockMatrix<double> matrix = std::move(next.coarse.matrix);
      const int nodes = own.pattern.nodes;
      if (6 * nodes > kDirectUnknowns) {
        inverse = inverse_blocks(matrix, nodes);
        next = aggregate<6>({&own.pattern, &matrix, &inverse, &next.motions});
      }
      // Pieces that nothing connects cannot be aggregated further.
      if (6 * nodes <= kDirectUnknowns || next.coarse.pattern.nodes >= nodes) {
        factorize(own.pattern, matrix);
        return;
      }
      own.lower.assign(matrix.lower.begin(), matrix.lower.end());
      levels_.push_back(
          {6, &own.pattern, own.lower.data(), padded<6>(inverse)});
    }
  }

  void factorize(const BlockPattern& pattern,
                 const BlockMatrix<double>& matrix) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < pattern.nodes; ++i) {
      for (int r = 0; r < 6; ++r) {
        const double d = matrix.diagonal[36L * i + 7L * r];
        for (int c = 0; c < r; ++c) {
          entries.emplace_back(6 * i + r, 6 * i + c,
                               matrix.diagonal[36L * i + 6L * r + c]);
        }
        entries.emplace_back(6 * i + r, 6 * i + r, d > 0.0 ? d : 1.0);
        for (int k = pattern.start[i]; k < pattern.start[i + 1]; ++k) {
          for (int c = 0; c < 6; ++c) {
            entries.emplace_back(6 * i + r, 6 * pattern.column[k] + c,
                                 matrix.lower[36L * k + 6L * r + c]);
          }
        }
      }
    }
    SparseMatrix A(6L * pattern.nodes, 6L * pattern.nodes);
    A.setFromTriplets(entries.begin(), entries.end());
    factor_ = std::make_unique<SymmetricFactor>(A, FactorKind::Cholesky);
    if (!factor_->factorize(A)) {
      throw SolverError(
          "the coarse stiffness matrix is not positive definite: a piece of "
          "the part hangs on a single node or edge and can turn, or the "
          "elements are nearly flat");
    }
  }

  template <int K>
  void run(const std::vector<double>& r, std::vector<double>& z) const {
    double largest = 0.0;
#pragma omp parallel for schedule(static) \
    reduction(max                         \
              : largest) if (r.size() >= kParallelRows)
    for (std::size_t d = 0; d < r.size(); ++d) {
      largest = std::max(largest, std::abs(r[d]));
    }
    if (!(largest > 0.0)) {
      std::fill(z.begin(), z.end(), 0.0);
      return;
    }
    // Scaled so that single precision neither overflows nor underflows.
    const auto count = static_cast<Eigen::Index>(r.size());
    LevelVector right(count);
    over_numbers(count, [&](Eigen::Index d) {
      right[d] = static_cast<float>(r[d] / largest);
    });
    LevelVector x;
    cycle<K>(0, right, x);
    const double scale = largest / scale_;
    over_numbers(count, [&](Eigen::Index d) { z[d] = scale * x[d]; });
  }

  /// x = M right on level l, right's padding is not read.
  template <int K>
  void cycle(std::size_t l, const LevelVector& right, LevelVector& x) const {
    if (l == levels_.size()) {
      return solve<K>(right, x);
    }
    const Level& level = levels_[l];
    x.resize(level.size(K));
    LevelVector upper(level.size(K));
    forward<K>(level, right.data(), x.data(), upper.data());
    correct<K>(l, upper, x);
    over_numbers(upper.size(), [&](Eigen::Index d) { upper[d] = 0.0F; });
    backward<K>(level, right.data(), x.data(), upper.data());
  }

  template <int K>
  void multiply_nodal(const LevelVector& x, LevelVector& y) const {
    const Level& level = levels_[nodal_at()];
    multiply<3, K>(*level.pattern, nodal_diagonal_.data(), level.lower,
                   x.data(), y.data());
  }

  /// Several cycles on the nodal level below ten-node elements.
  template <int K>
  void nodal_cycles(LevelVector& right, LevelVector& x) const {
    cycle<K>(1, right, x);
    if (nodal_steps_.size() == 1) {
      return;
    }
    const auto first = static_cast<float>(nodal_steps_[0].take);
    LevelVector d(x.size());
    over_numbers(x.size(), [&](Eigen::Index i) {
      x[i] *= first;
      d[i] = x[i];
    });
    LevelVector q(x.size());
    LevelVector z;
    for (std::size_t s = 1; s < nodal_steps_.size(); ++s) {
      const auto keep = static_cast<float>(nodal_steps_[s].keep);
      const auto take = static_cast<float>(nodal_steps_[s].take);
      multiply_nodal<K>(d, q);
      over_numbers(q.size(), [&](Eigen::Index i) { right[i] -= q[i]; });
      cycle<K>(1, right, z);
      over_numbers(q.size(), [&](Eigen::Index i) {
        d[i] = keep * d[i] + take * z[i];
        x[i] += d[i];
      });
    }
  }

  /// Chooses the cycles on the nodal level by its cycle's lowest eigenvalue.
  void accelerate_nodal(const NodalLevel& nodal) {
    const double scale = nodal.smoother->scale;
    nodal_diagonal_.reserve(nodal.matrix->diagonal.size());
    for (const double value : nodal.matrix->diagonal) {
      nodal_diagonal_.push_back(static_cast<float>(value / scale));
    }
    const double lowest = lowest_eigenvalue();
    nodal_steps_ = chebyshev_steps(std::min(lowest, 1.0), kHighest,
                                   kNodalReduction, kMostNodalCycles);
  }

  /// Of one cycle times the matrix on the nodal level: Lanczos' process by
  /// conjugate gradients from a fixed random start.
  double lowest_eigenvalue() const {
    LevelVector r(levels_[1].size(1));
    std::minstd_rand random;
    for (float& value : r) {
      value = static_cast<float>(random()) /
                  static_cast<float>(std::minstd_rand::max()) -
              0.5F;
    }
    nodal_held_.apply<1>(r.data());
    const auto dot = [](const LevelVector& a, const LevelVector& b) {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < a.size(); ++i) {
        sum += i % 4 < 3 ? static_cast<double>(a[i]) * b[i] : 0.0;
      }
      return sum;
    };
    std::vector<double> alpha;
    std::vector<double> beta;
    LevelVector z;
    LevelVector p = LevelVector::Zero(r.size());
    LevelVector q(r.size());
    double last = 0.0;
    for (int k = 0; k < kLanczosSteps; ++k) {
      cycle<1>(1, r, z);
      const double rz = dot(r, z);
      const double b = k > 0 ? rz / last : 0.0;
      last = rz;
      p = z + static_cast<float>(b) * p;
      multiply_nodal<1>(p, q);
      const double pq = dot(p, q);
      if (!(rz > 0.0 && pq > 0.0)) {
        break;
      }
      alpha.push_back(rz / pq);
      beta.push_back(b);
      r -= static_cast<float>(alpha.back()) * q;
    }
    return alpha.empty() ? 1.0 : lowest_ritz_value(alpha, beta);
  }

  /// Adds the coarse correction of the residual, which is -upper.
  template <int K>
  void correct(std::size_t l, LevelVector& upper, LevelVector& x) const {
    LevelVector e;
    if (map_ != nullptr && l == 0) {
      fine_held_.apply<K>(upper.data());
      LevelVector right(levels_[1].size(K));
      restrict_corners<K>(*map_, nodal_factor_, upper.data(), right.data());
      nodal_held_.apply<K>(right.data());
      nodal_cycles<K>(right, e);
      prolong_corners<K>(*map_, e.data(), x.data());
      fine_held_.apply<K>(x.data());
      return;
    }
    const OwnLevel& next = *own_[l - nodal_at()];
    const Prolongation& P = next.prolongation;
    LevelVector right(static_cast<Eigen::Index>(K) * kLanes<6> *
                      next.pattern.nodes);
    if (P.fine_block == 3) {
      restrict_motions<3, K>(P, upper.data(), right.data());
      cycle<K>(l + 1, right, e);
      prolong_motions<3, K>(P, e.data(), x.data());
    } else {
      restrict_motions<6, K>(P, upper.data(), right.data());
      cycle<K>(l + 1, right, e);
      prolong_motions<6, K>(P, e.data(), x.data());
    }
  }

  /// The smallest level.
  template <int K>
  void solve(const LevelVector& right, LevelVector& x) const {
    const int nodes = own_.back()->pattern.nodes;
    Eigen::MatrixXd b(6L * nodes, K);
    for (int i = 0; i < nodes; ++i) {
      for (int k = 0; k < K; ++k) {
        for (int d = 0; d < 6; ++d) {
          b(6L * i + d, k) =
              right[(static_cast<std::size_t>(i) * K + k) * kLanes<6> + d];
        }
      }
    }
    const Eigen::MatrixXd e = factor_->solve(b);
    x = LevelVector::Zero(right.size());
    for (int i = 0; i < nodes; ++i) {
      for (int k = 0; k < K; ++k) {
        for (int d = 0; d < 6; ++d) {
          x[(static_cast<std::size_t>(i) * K + k) * kLanes<6> + d] =
              static_cast<float>(e(6L * i + d, k));
        }
      }
    }
  }

  /// What belongs to an aggregate level.
  struct OwnLevel {
    Prolongation prolongation;  // to the next finer level
    BlockPattern pattern;
    std::vector<float> lower;
  };

  const CornerMap* map_;
  HeldNodes fine_held_;
  NodeFreedom nodal_freedom_;
  HeldNodes nodal_held_;
  double scale_ = 1.0;         // of the finest level's matrix
  float nodal_factor_ = 1.0F;  // finest scale over the nodal level's
  // Below ten-node elements:
  std::vector<float> nodal_diagonal_;
  std::vector<ChebyshevStep> nodal_steps_;
  std::vector<Level> levels_;  // those with a smoother
  std::vector<std::unique_ptr<OwnLevel>> own_;
  std::unique_ptr<SymmetricFactor> factor_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid(const MultigridInput& input) {
  return std::make_unique<Multigrid>(input);
}

SmootherMatrix make_smoother_matrix(const BlockMatrix<double>& matrix) {
  SmootherMatrix result;
  result.scale =
      *std::max_element(matrix.diagonal.begin(), matrix.diagonal.end());
  const double factor = 1.0 / result.scale;
  result.lower.resize(matrix.lower.size());
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < matrix.lower.size(); ++k) {
    result.lower[k] = static_cast<float>(factor * matrix.lower[k]);
  }
  return result;
}

}  // namespace meniscus::solver
