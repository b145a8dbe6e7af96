#include "fea/multigrid.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/error.h"
#include "core/linear_solve.h"
#include "fea/block_kernels.h"
#include "fea/block_sweeps.h"
#include "fea/smoothed_aggregation.h"

namespace meniscus {

namespace {

/// Up to this many unknowns a level is solved by its Cholesky factor.
constexpr int kDirectUnknowns = 1500;
/// Cycles over the coarser levels for one on the finest: they cost little.
constexpr int kCoarseCycles = 2;

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

NodeFreedom corner_freedom(const NodeFreedom& fine, const CornerMap& map) {
  NodeFreedom result;
  result.nodes = static_cast<int>(map.corner.size());
  for (std::size_t k = 0; k < fine.held.size(); ++k) {
    const auto at =
        std::lower_bound(map.corner.begin(), map.corner.end(), fine.held[k]);
    if (at != map.corner.end() && *at == fine.held[k]) {
      result.held.push_back(static_cast<int>(at - map.corner.begin()));
      result.projector.push_back(fine.projector[k]);
    }
  }
  return result;
}

/// Inverses of the scaled diagonal blocks on the free directions.
std::vector<double> inverse_blocks(const BlockMatrix<double>& matrix,
                                   double scale, const NodeFreedom& freedom) {
  std::vector<double> inverse(9L * freedom.nodes);
#pragma omp parallel for schedule(static) if (freedom.nodes >= kParallelRows)
  for (int i = 0; i < freedom.nodes; ++i) {
    Eigen::Map<RowMat3>(inverse.data() + 9L * i) =
        (Eigen::Map<const RowMat3>(matrix.diagonal.data() + 9L * i) / scale)
            .inverse();
  }
  for (std::size_t k = 0; k < freedom.held.size(); ++k) {
    const long at = 9L * freedom.held[k];
    const Mat3& P = freedom.projector[k];
    const RowMat3 D =
        Eigen::Map<const RowMat3>(matrix.diagonal.data() + at) / scale;
    const RowMat3 within = P * D * P + (Mat3::Identity() - P);
    Eigen::Map<RowMat3>(inverse.data() + at) = P * within.inverse() * P;
  }
  return inverse;
}

/// The same for motions of aggregates; those that are none have a zero row.
std::vector<double> inverse_blocks(const BlockMatrix<double>& matrix,
                                   int nodes) {
  using Mat6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  std::vector<double> inverse(36L * nodes);
#pragma omp parallel for schedule(static) if (nodes >= kParallelRows)
  for (int i = 0; i < nodes; ++i) {
    Mat6 D = Eigen::Map<const Mat6>(matrix.diagonal.data() + 36L * i);
    Mat6 none = Mat6::Zero();
    for (int k = 0; k < 6; ++k) {
      none(k, k) = D(k, k) > 0.0 ? 0.0 : 1.0;
    }
    Eigen::Map<Mat6>(inverse.data() + 36L * i) = (D + none).inverse() - none;
  }
  return inverse;
}

template <int B>
std::vector<float> padded(const std::vector<double>& blocks) {
  const std::size_t rows = blocks.size() / B;
  std::vector<float> result(rows * kLanes<B>, 0.0F);
  for (std::size_t r = 0; r < rows; ++r) {
    for (int c = 0; c < B; ++c) {
      result[r * kLanes<B> + c] = static_cast<float>(blocks[r * B + c]);
    }
  }
  return result;
}

/// Translations and rotations about the middle, in units of the part's size.
std::vector<double> rigid_motions(const Points& x, const NodeFreedom& freedom) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : x) {
    centre += p / static_cast<double>(x.size());
  }
  double size = 0.0;
  for (const Vec3& p : x) {
    size = std::max(size, (p - centre).norm());
  }
  using Motions = Eigen::Matrix<double, 3, kRigidMotions, Eigen::RowMajor>;
  std::vector<double> result(18 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 d = (x[i] - centre) / size;
    Motions m;
    m << 1, 0, 0, 0, d.z(), -d.y(),  //
        0, 1, 0, -d.z(), 0, d.x(),   //
        0, 0, 1, d.y(), -d.x(), 0;
    Eigen::Map<Motions>(result.data() + 18 * i) = m;
  }
  for (std::size_t k = 0; k < freedom.held.size(); ++k) {
    Eigen::Map<Motions> m(result.data() + 18L * freedom.held[k]);
    m = (freedom.projector[k] * m).eval();
  }
  return result;
}

/// A level's smoother. Vectors as block_sweeps.h has them.
struct Level {
  int block = 3;
  const BlockPattern* pattern = nullptr;
  const float* lower = nullptr;
  std::vector<float> inverse;

  std::size_t width(int K) const {
    return static_cast<std::size_t>(K) * (block == 3 ? kLanes<3> : kLanes<6>);
  }
  std::size_t size(int K) const { return width(K) * pattern->nodes; }
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

/// coarse = -P^T upper; both with padding, the coarse one's garbage.
template <int B, int K>
void restrict_motions(const Prolongation& P, const float* upper,
                      float* coarse) {
  constexpr std::ptrdiff_t kFine = K * kLanes<B>;
  constexpr std::ptrdiff_t kCoarse = K * kLanes<6>;
  const int count = static_cast<int>(P.row_start.size()) - 1;
#pragma omp parallel for schedule(static) if (count >= kParallelRows)
  for (int a = 0; a < count; ++a) {
    Eigen::Map<Eigen::Array<float, kCoarse, 1>> sum(coarse + a * kCoarse);
    sum.setZero();
    for (int t = P.row_start[a]; t < P.row_start[a + 1]; ++t) {
      const float* block =
          P.value.data() + static_cast<std::ptrdiff_t>(6 * B) * P.block[t];
      const float* u = upper + P.row[t] * kFine;
      for (int k = 0; k < K; ++k) {
        for (int r = 0; r < B; ++r) {
          lanes<6>(coarse + a * kCoarse + k * kLanes<6>) -=
              lanes<6>(block + 6 * r) * u[k * kLanes<B> + r];
        }
      }
    }
  }
}

/// x += P e.
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
    std::vector<float> right(r.size());
    std::vector<float> x(r.size());
#pragma omp parallel for schedule(static) if (r.size() >= kParallelRows)
    for (std::size_t d = 0; d < r.size(); ++d) {
      right[d] = static_cast<float>(r[d] / largest);
    }
    cycle<K>(0, right, x);
    const double scale = largest / scale_;
#pragma omp parallel for schedule(static) if (r.size() >= kParallelRows)
    for (std::size_t d = 0; d < r.size(); ++d) {
      z[d] = scale * x[d];
    }
  }

  /// x = M right on level l, right's padding is not read.
  template <int K>
  void cycle(std::size_t l, const std::vector<float>& right,
             std::vector<float>& x) const {
    if (l == levels_.size()) {
      return solve<K>(right, x);
    }
    const Level& level = levels_[l];
    x.assign(level.size(K), 0.0F);
    std::vector<float> upper(level.size(K), 0.0F);
    const int cycles =
        map_ != nullptr && static_cast<int>(l) == 1 ? kCoarseCycles : 1;
    for (int c = 0; c < cycles; ++c) {
      forward<K>(level, right.data(), x.data(), upper.data());
      correct<K>(l, upper, x);
      std::fill(upper.begin(), upper.end(), 0.0F);
      backward<K>(level, right.data(), x.data(), upper.data());
    }
  }

  /// Adds the coarse correction of the residual, which is -upper.
  template <int K>
  void correct(std::size_t l, std::vector<float>& upper,
               std::vector<float>& x) const {
    std::vector<float> e;
    if (map_ != nullptr && l == 0) {
      fine_held_.apply<K>(upper.data());
      std::vector<float> right(levels_[1].size(K));
      restrict_corners<K>(upper.data(), right.data());
      nodal_held_.apply<K>(right.data());
      cycle<K>(1, right, e);
      prolong_corners<K>(e.data(), x.data());
      fine_held_.apply<K>(x.data());
      return;
    }
    const OwnLevel& next = *own_[l - nodal_at()];
    const Prolongation& P = next.prolongation;
    std::vector<float> right(static_cast<std::size_t>(K) * kLanes<6> *
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

  template <int K>
  void restrict_corners(const float* upper, float* coarse) const {
    using Node = Eigen::Array<float, 4 * K, 1>;
    const auto at = [&](int node) {
      return Eigen::Map<const Node>(upper +
                                    static_cast<std::ptrdiff_t>(4 * K) * node);
    };
    const int count = static_cast<int>(map_->corner.size());
#pragma omp parallel for schedule(static) if (count >= kParallelRows)
    for (int c = 0; c < count; ++c) {
      Node mids = Node::Zero();
      for (int k = map_->around_start[c]; k < map_->around_start[c + 1]; ++k) {
        mids += at(map_->around[k]);
      }
      Eigen::Map<Node>(coarse + static_cast<std::ptrdiff_t>(4 * K) * c) =
          -nodal_factor_ * (at(map_->corner[c]) + 0.5F * mids);
    }
  }

  template <int K>
  void prolong_corners(const float* e, float* x) const {
    using Node = Eigen::Array<float, 4 * K, 1>;
    const auto coarse = [&](int c) {
      return Eigen::Map<const Node>(e + static_cast<std::ptrdiff_t>(4 * K) * c);
    };
    const auto fine = [&](int node) {
      return Eigen::Map<Node>(x + static_cast<std::ptrdiff_t>(4 * K) * node);
    };
    const int corners = static_cast<int>(map_->corner.size());
#pragma omp parallel for schedule(static) if (corners >= kParallelRows)
    for (int c = 0; c < corners; ++c) {
      fine(map_->corner[c]) += coarse(c);
    }
    const int mids = static_cast<int>(map_->mid.size());
#pragma omp parallel for schedule(static) if (mids >= kParallelRows)
    for (int m = 0; m < mids; ++m) {
      fine(map_->mid[m]) +=
          0.5F * (coarse(map_->ends[m][0]) + coarse(map_->ends[m][1]));
    }
  }

  /// The smallest level.
  template <int K>
  void solve(const std::vector<float>& right, std::vector<float>& x) const {
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
    x.assign(right.size(), 0.0F);
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

}  // namespace meniscus
