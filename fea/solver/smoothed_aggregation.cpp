#include "fea/solver/smoothed_aggregation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fea/solver/block_kernels.h"
#include "fea/solver/node_clusters.h"

namespace meniscus::solver {

namespace {

constexpr int kM = kRigidMotions;

template <int R, int C>
using Dense = Eigen::Matrix<double, R, C, Eigen::RowMajor>;
template <int R, int C>
using ConstBlock = Eigen::Map<const Dense<R, C>>;
template <int R, int C>
using MutableBlock = Eigen::Map<Dense<R, C>>;

template <int R, int C>
ConstBlock<R, C> block_at(const std::vector<double>& v, std::ptrdiff_t i) {
  return ConstBlock<R, C>(v.data() + R * C * i);
}

template <int R, int C>
MutableBlock<R, C> block_at(std::vector<double>& v, std::ptrdiff_t i) {
  return MutableBlock<R, C>(v.data() + R * C * i);
}

/// A motion of which orthogonalisation leaves less than this is one that the
/// aggregate cannot make by itself.
constexpr double kDependent = 1e-6;

/// Smoothing of the prolongation: damping over the largest eigenvalue of
/// D^-1 A, which power iterations approach from below.
constexpr double kDamping = 4.0 / 3.0;
constexpr int kPowerSteps = 12;
constexpr double kPowerMargin = 1.05;

/// Orthonormal motions of each aggregate, B x 6 a node, and its R: Gram and
/// Schmidt twice, dependent motions dropped.
template <int B>
std::vector<double> tentative(const Members& members,
                              const std::vector<double>& motions,
                              std::vector<double>& coarse_motions) {
  const int count = static_cast<int>(members.start.size()) - 1;
  std::vector<double> Q(motions.size(), 0.0);
  coarse_motions.assign(static_cast<std::size_t>(kM) * kM * count, 0.0);
#pragma omp parallel for schedule(static) if (count >= kParallelRows)
  for (int a = 0; a < count; ++a) {
    const int first = members.start[a];
    const int nodes = members.start[a + 1] - first;
    Eigen::Matrix<double, Eigen::Dynamic, kM> q(B * nodes, kM);
    for (int k = 0; k < nodes; ++k) {
      q.template middleRows<B>(B * k) =
          block_at<B, kM>(motions, members.node[first + k]);
    }
    auto R = block_at<kM, kM>(coarse_motions, a);
    for (int c = 0; c < kM; ++c) {
      const double before = q.col(c).norm();
      for (int pass = 0; pass < 2; ++pass) {
        for (int d = 0; d < c; ++d) {
          const double along = q.col(d).dot(q.col(c));
          R(d, c) += along;
          q.col(c) -= along * q.col(d);
        }
      }
      const double norm = q.col(c).norm();
      const bool kept = norm > kDependent * before;
      R(c, c) = kept ? norm : 0.0;
      q.col(c) *= kept ? 1.0 / norm : 0.0;
    }
    for (int k = 0; k < nodes; ++k) {
      block_at<B, kM>(Q, members.node[first + k]) =
          q.template middleRows<B>(B * k);
    }
  }
  return Q;
}

template <int B>
class Coarsening {
 public:
  explicit Coarsening(const FineLevel& fine)
      : fine_(fine), n_(fine.pattern->nodes), rows_(*fine.pattern) {}

  AggregateLevel run() {
    std::vector<char> active(n_);
    for (int i = 0; i < n_; ++i) {
      active[i] = block_at<B, kM>(*fine_.motions, i).isZero(0.0) ? 0 : 1;
    }
    clusters_ = cluster(rows_, active);
    Q_ = tentative<B>(Members(clusters_), *fine_.motions, level_.motions);
    smooth();
    transpose_index();
    multiply_by_matrix();
    multiply_by_transpose();
    return std::move(level_);
  }

 private:
  Dense<B, B> coupling(int i, int k) const {
    const auto block = block_at<B, B>(fine_.matrix->lower, rows_.block[k]);
    return rows_.node[k] < i ? Dense<B, B>(block)
                             : Dense<B, B>(block.transpose());
  }
  ConstBlock<B, B> diagonal(int i) const {
    return block_at<B, B>(fine_.matrix->diagonal, i);
  }
  ConstBlock<B, B> inverse(int i) const {
    return block_at<B, B>(*fine_.inverse, i);
  }

  /// Largest eigenvalue of D^-1 A.
  double largest_eigenvalue() const {
    VectorX x(static_cast<Eigen::Index>(B) * n_);
    for (Eigen::Index d = 0; d < x.size(); ++d) {  // any vector without pattern
      x[d] = std::sin(1.0 + 12.9898 * static_cast<double>(d));
    }
    double value = 1.0;
    for (int step = 0; step < kPowerSteps; ++step) {
      x /= x.norm();
      VectorX y(x.size());
#pragma omp parallel for schedule(static) if (n_ >= kParallelRows)
      for (int i = 0; i < n_; ++i) {
        Eigen::Matrix<double, B, 1> sum =
            diagonal(i) * x.template segment<B>(B * i);
        for (int k = rows_.start[i]; k < rows_.start[i + 1]; ++k) {
          sum += coupling(i, k) * x.template segment<B>(B * rows_.node[k]);
        }
        y.template segment<B>(B * i) = inverse(i) * sum;
      }
      value = y.norm();
      x = y;
      if (!(value > 0.0)) {
        return 1.0;
      }
    }
    return kPowerMargin * value;
  }

  /// Sorted aggregates that `touch(emit)` names.
  template <class Touch>
  static void list_columns(int rows, const Touch& touch,
                           std::vector<int>& start, std::vector<int>& column) {
    start.assign(1, 0);
    std::vector<int> found;
    for (int i = 0; i < rows; ++i) {
      found.clear();
      touch(i, [&](int a) {
        if (a >= 0 && std::find(found.begin(), found.end(), a) == found.end()) {
          found.push_back(a);
        }
      });
      std::sort(found.begin(), found.end());
      column.insert(column.end(), found.begin(), found.end());
      start.push_back(static_cast<int>(column.size()));
    }
  }

  /// P = (I - omega D^-1 A) Q.
  void smooth() {
    Prolongation& P = level_.prolongation;
    P.fine_block = B;
    list_columns(
        n_,
        [&](int i, const auto& emit) {
          emit(clusters_.of[i]);
          for (int k = rows_.start[i]; k < rows_.start[i + 1]; ++k) {
            emit(clusters_.of[rows_.node[k]]);
          }
        },
        P.start, P.column);
    P_.assign(static_cast<std::size_t>(B * kM) * P.column.size(), 0.0);
    const double omega = kDamping / largest_eigenvalue();
#pragma omp parallel for schedule(static) if (n_ >= kParallelRows)
    for (int i = 0; i < n_; ++i) {
      const auto add = [&](int j, const Dense<B, B>& Aij) {
        if (clusters_.of[j] >= 0) {
          at(P.start, P.column, P_, i, clusters_.of[j]).noalias() +=
              Aij * block_at<B, kM>(Q_, j);
        }
      };
      add(i, diagonal(i));
      for (int k = rows_.start[i]; k < rows_.start[i + 1]; ++k) {
        add(rows_.node[k], coupling(i, k));
      }
      for (int k = P.start[i]; k < P.start[i + 1]; ++k) {
        auto block = block_at<B, kM>(P_, k);
        block = (-omega * inverse(i) * block).eval();
        if (P.column[k] == clusters_.of[i]) {
          block += block_at<B, kM>(Q_, i);
        }
      }
    }
    P.value.assign(P_.begin(), P_.end());
    P.value.resize(P.value.size() + kBlockPadding, 0.0F);
  }

  static MutableBlock<B, kM> at(const std::vector<int>& start,
                                const std::vector<int>& column,
                                std::vector<double>& value, int i, int a) {
    const auto k = std::lower_bound(column.begin() + start[i],
                                    column.begin() + start[i + 1], a) -
                   column.begin();
    return block_at<B, kM>(value, k);
  }

  void transpose_index() {
    Prolongation& P = level_.prolongation;
    P.row_start.assign(clusters_.count + 1, 0);
    for (const int a : P.column) {
      ++P.row_start[a + 1];
    }
    std::partial_sum(P.row_start.begin(), P.row_start.end(),
                     P.row_start.begin());
    P.row.resize(P.column.size());
    P.block.resize(P.column.size());
    P.row_value.resize(P.value.size());
    std::vector<int> next(P.row_start.begin(), P.row_start.end() - 1);
    for (int i = 0; i < n_; ++i) {
      for (int k = P.start[i]; k < P.start[i + 1]; ++k) {
        const int t = next[P.column[k]]++;
        P.row[t] = i;
        P.block[t] = k;
        std::copy_n(
            P.value.begin() + static_cast<std::ptrdiff_t>(B * kM) * k, B * kM,
            P.row_value.begin() + static_cast<std::ptrdiff_t>(B * kM) * t);
      }
    }
  }

  /// A P, row by row.
  void multiply_by_matrix() {
    const Prolongation& P = level_.prolongation;
    list_columns(
        n_,
        [&](int i, const auto& emit) {
          const auto row = [&](int j) {
            for (int k = P.start[j]; k < P.start[j + 1]; ++k) {
              emit(P.column[k]);
            }
          };
          row(i);
          for (int k = rows_.start[i]; k < rows_.start[i + 1]; ++k) {
            row(rows_.node[k]);
          }
        },
        product_start_, product_column_);
    product_.assign(static_cast<std::size_t>(B * kM) * product_column_.size(),
                    0.0);
#pragma omp parallel for schedule(static) if (n_ >= kParallelRows)
    for (int i = 0; i < n_; ++i) {
      const auto add = [&](int j, const Dense<B, B>& Aij) {
        for (int k = P.start[j]; k < P.start[j + 1]; ++k) {
          at(product_start_, product_column_, product_, i, P.column[k])
              .noalias() += Aij * block_at<B, kM>(P_, k);
        }
      };
      add(i, diagonal(i));
      for (int k = rows_.start[i]; k < rows_.start[i + 1]; ++k) {
        add(rows_.node[k], coupling(i, k));
      }
    }
  }

  /// The lower half of P^T (A P).
  void multiply_by_transpose() {
    const Prolongation& P = level_.prolongation;
    BlockPattern& pattern = level_.coarse.pattern;
    BlockMatrix<double>& matrix = level_.coarse.matrix;
    pattern.nodes = clusters_.count;
    pattern.chunks = one_chunk(clusters_.count);
    list_columns(
        clusters_.count,
        [&](int a, const auto& emit) {
          for (int t = P.row_start[a]; t < P.row_start[a + 1]; ++t) {
            const int i = P.row[t];
            for (int k = product_start_[i];
                 k < product_start_[i + 1] && product_column_[k] < a; ++k) {
              emit(product_column_[k]);
            }
          }
        },
        pattern.start, pattern.column);
    constexpr std::size_t kSize = static_cast<std::size_t>(kM) * kM;
    matrix.diagonal.assign(kSize * clusters_.count + kBlockPadding, 0.0);
    matrix.lower.assign(kSize * pattern.column.size() + kBlockPadding, 0.0);
#pragma omp parallel for schedule(static) if (clusters_.count >= kParallelRows)
    for (int a = 0; a < clusters_.count; ++a) {
      for (int t = P.row_start[a]; t < P.row_start[a + 1]; ++t) {
        const int i = P.row[t];
        const auto Pt = block_at<B, kM>(P_, P.block[t]).transpose();
        int place = pattern.start[a];
        for (int k = product_start_[i];
             k < product_start_[i + 1] && product_column_[k] <= a; ++k) {
          const int b = product_column_[k];
          const auto AP = block_at<B, kM>(product_, k);
          if (b == a) {
            block_at<kM, kM>(matrix.diagonal, a).noalias() += Pt * AP;
            continue;
          }
          while (pattern.column[place] < b) {
            ++place;
          }
          block_at<kM, kM>(matrix.lower, place).noalias() += Pt * AP;
        }
      }
      // Rounding makes it unsymmetric; the sweeps want it symmetric.
      auto D = block_at<kM, kM>(matrix.diagonal, a);
      D = (0.5 * (D + D.transpose())).eval();
    }
  }

  const FineLevel fine_;
  const int n_;
  const FullRows rows_;
  Clusters clusters_;
  std::vector<double> Q_;
  std::vector<double> P_;
  std::vector<int> product_start_;
  std::vector<int> product_column_;
  std::vector<double> product_;
  AggregateLevel level_;
};

}  // namespace

template <int B>
AggregateLevel aggregate(const FineLevel& fine) {
  return Coarsening<B>(fine).run();
}

template AggregateLevel aggregate<3>(const FineLevel& fine);
template AggregateLevel aggregate<6>(const FineLevel& fine);

}  // namespace meniscus::solver
