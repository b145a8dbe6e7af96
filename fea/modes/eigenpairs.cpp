#include "fea/modes/eigenpairs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/math/dense.h"
#include "fea/solver/conjugate_gradients.h"

namespace meniscus::modes {

namespace {

/// Eigenvalues of a scaled Gram matrix below this are linear dependence.
constexpr double kDependent = 1e-9;
/// A settled vector is left alone until its residual has grown by this.
constexpr double kUnsettled = 2.0;

/// Iterations in which an eigenvalue above the floor shows itself.
constexpr int kEnoughToRise = 8;
/// The least number after which vectors to begin with may be the answer: what
/// they lack shows itself among the guards.
constexpr int kEnoughToShow = 6;

/// A fixed sequence of numbers in (-1, 1): splitmix64.
double noise(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return std::ldexp(static_cast<double>(z >> 11), -52) - 1.0;
}

/// T with T^T G T = I over all that is independent in the basis of Gram
/// matrix G; no columns when nothing is.
struct Basis {
  Eigen::MatrixXd T;
  bool positive = true;  // G is semidefinite, but for rounding
};

Basis orthonormal(const Eigen::MatrixXd& G) {
  const VectorX d = G.diagonal().unaryExpr(
      [](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  const Eigen::MatrixXd scaled = d.asDiagonal() * G * d.asDiagonal();
  const auto eigen = symmetric_eigen(scaled);
  const VectorX& values = eigen.values;
  const Eigen::Index n = values.size();
  Eigen::Index dropped = 0;
  while (dropped < n && !(values[dropped] > kDependent)) {
    ++dropped;
  }
  const Eigen::Index kept = n - dropped;
  return {.T = d.asDiagonal() * eigen.vectors.rightCols(kept) *
               values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal(),
          .positive = n == 0 || (values[0] > -kDependent &&
                                 G.diagonal().minCoeff() >= 0.0)};
}

/// The blocks X, P and W stand side by side in S; KS = K S, AS = A S.
class EigenSearch {
 public:
  EigenSearch(const EigenProblem& problem, const EigenOptions& options)
      : problem_(problem), options_(options), rows_(problem.rows) {}

  EigenPairs run(const solver::Columns& start);

 private:
  Eigen::Index block_size(Eigen::Index given) const;
  void apply_both(Eigen::Index first, Eigen::Index count);
  void begin(const solver::Columns& start);
  bool improve(Eigen::Index lead);
  void measure();
  bool all_settled() const;
  void add_search_directions();
  double scale(Eigen::Index k) const {
    return std::max({std::abs(theta_[k]), options_.floor, 1e-300});
  }
  bool settled(Eigen::Index k) const {
    return residuals_[k] <= options_.tolerance || below_floor(k);
  }
  bool below_floor(Eigen::Index k) const {
    return iterations_ >= kEnoughToRise &&
           theta_[k] + residuals_[k] * scale(k) <= options_.floor;
  }
  EigenPairs finish();

  const EigenProblem& problem_;
  const EigenOptions& options_;
  Eigen::Index rows_;
  Eigen::Index m_ = 0;  // columns of X
  Eigen::Index p_ = 0;  // of P
  Eigen::Index w_ = 0;  // of W
  solver::Columns S_, KS_, AS_;
  VectorX theta_;
  VectorX residuals_;      // relative
  VectorX norms_;          // of A x - theta K x
  VectorX settled_norms_;  // where settled: when it was measured
  VectorX settled_theta_;
  EigenEnd end_ = EigenEnd::Converged;
  int iterations_ = 0;
};

Eigen::Index EigenSearch::block_size(Eigen::Index given) const {
  Eigen::Index block =
      std::max<Eigen::Index>(options_.count, given) + options_.guards;
  if (block > solver::kMostColumns) {  // whole fours cost no more
    block = (block + solver::kMostColumns - 1) / solver::kMostColumns *
            solver::kMostColumns;
  }
  return std::min<Eigen::Index>(block, problem_.dimension);
}

void EigenSearch::apply_both(Eigen::Index first, Eigen::Index count) {
  problem_.K(S_.middleCols(first, count), KS_.middleCols(first, count));
  problem_.A(S_.middleCols(first, count), AS_.middleCols(first, count));
}

void EigenSearch::begin(const solver::Columns& start) {
  m_ = block_size(start.cols());
  for (solver::Columns* block : {&S_, &KS_, &AS_}) {
    block->resize(rows_, 3 * m_);
  }
  const Eigen::Index given = std::min(start.cols(), m_);
  auto X = S_.leftCols(m_);
  for (Eigen::Index k = given; k < m_; ++k) {
    for (Eigen::Index i = 0; i < rows_; ++i) {
      X(i, k) = noise(static_cast<std::uint64_t>(k * rows_ + i));
    }
  }
  problem_.project(X);
  // One step of inverse iteration leaves little of the roughness.
  problem_.A(S_.middleCols(given, m_ - given),
             AS_.middleCols(given, m_ - given));
  problem_.preconditioner(AS_.middleCols(given, m_ - given),
                          S_.middleCols(given, m_ - given));
  if (given > 0) {
    S_.leftCols(given) = start.leftCols(given);
    problem_.project(S_.leftCols(given));
  }
  apply_both(0, m_);
}

/// Rayleigh-Ritz on the whole basis; `lead`: the columns of X in it.
bool EigenSearch::improve(Eigen::Index lead) {
  const Eigen::Index k = lead + p_ + w_;
  const Eigen::MatrixXd GK = solver::gram(S_.leftCols(k), KS_.leftCols(k));
  const Eigen::MatrixXd GA = solver::gram(S_.leftCols(k), AS_.leftCols(k));
  if (!GK.allFinite() || !GA.allFinite()) {
    end_ = EigenEnd::NotFinite;
    return false;
  }
  const Basis basis = orthonormal(0.5 * (GK + GK.transpose()));
  if (!basis.positive) {
    end_ = EigenEnd::NotPositive;
    return false;
  }
  if (basis.T.cols() == 0) {  // A is 0 on the free directions
    m_ = 0;
    theta_.resize(0);
    return false;
  }
  const Eigen::MatrixXd H = basis.T.transpose() * GA * basis.T;
  const Eigen::MatrixXd even = 0.5 * (H + H.transpose());
  const auto eigen = symmetric_eigen(even);
  m_ = std::min(m_, H.rows());
  theta_ = eigen.values.reverse().head(m_);
  Eigen::MatrixXd C = basis.T * eigen.vectors.rowwise().reverse().leftCols(m_);
  p_ = 0;
  if (k > lead) {
    // What the step added, without its part along the new X.
    Eigen::MatrixXd D = C;
    D.topRows(lead).setZero();
    D -= C * (C.transpose() * GK * D);
    const Eigen::MatrixXd GD = D.transpose() * GK * D;
    D *= orthonormal(0.5 * (GD + GD.transpose())).T;
    p_ = D.cols();
    C.conservativeResize(k, m_ + p_);
    C.rightCols(p_) = D;
  }
  for (solver::Columns* block : {&S_, &KS_, &AS_}) {
    solver::combine(C, block->leftCols(k));
  }
  w_ = 0;
  return true;
}

/// Residuals of all X; W becomes the preconditioned ones of those that have
/// not settled.
void EigenSearch::measure() {
  const Eigen::Index at = m_ + p_;
  auto R = KS_.middleCols(at, m_);
  R = AS_.leftCols(m_) - KS_.leftCols(m_) * theta_.asDiagonal();
  norms_ = solver::gram(R, R).diagonal().cwiseMax(0.0).cwiseSqrt();
  w_ = 0;
  std::vector<Eigen::Index> moving;
  for (Eigen::Index k = 0; k < m_; ++k) {
    const bool rests = k < settled_norms_.size() && settled_norms_[k] > 0.0 &&
                       norms_[k] <= kUnsettled * settled_norms_[k] &&
                       std::abs(theta_[k] - settled_theta_[k]) <=
                           options_.tolerance * scale(k);
    if (!rests) {
      R.col(w_++) = R.col(k).eval();
      moving.push_back(k);
    }
  }
  problem_.preconditioner(R.leftCols(w_), S_.middleCols(at, w_));
  const VectorX square =
      solver::gram(R.leftCols(w_), S_.middleCols(at, w_)).diagonal();
  residuals_.conservativeResize(m_);
  settled_norms_.conservativeResizeLike(VectorX::Zero(m_));
  settled_theta_.conservativeResizeLike(VectorX::Zero(m_));
  for (Eigen::Index j = 0; j < w_; ++j) {
    const Eigen::Index k = moving[j];
    if (square[j] < -std::pow(options_.tolerance * scale(k), 2)) {
      end_ = EigenEnd::NotPositive;  // and no rounding
    }
    residuals_[k] = std::sqrt(std::abs(square[j])) / scale(k);
    settled_norms_[k] = settled(k) ? norms_[k] : 0.0;
    settled_theta_[k] = theta_[k];
  }
}

bool EigenSearch::all_settled() const {
  const Eigen::Index count = std::min<Eigen::Index>(options_.count, m_);
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!settled(k)) {
      return false;
    }
  }
  return true;
}

/// W without its part along X and P, in the inner product of K.
void EigenSearch::add_search_directions() {
  const Eigen::Index at = m_ + p_;
  auto W = S_.middleCols(at, w_);
  solver::subtract(S_.leftCols(at), solver::gram(KS_.leftCols(at), W), W);
  apply_both(at, w_);
}

EigenPairs EigenSearch::finish() {
  EigenPairs pairs;
  pairs.iterations = iterations_;
  pairs.end = end_;
  if (end_ == EigenEnd::NotFinite || end_ == EigenEnd::NotPositive) {
    return pairs;
  }
  const Eigen::Index count = std::min<Eigen::Index>(options_.count, m_);
  // Recombined products have drifted: the figures are those of fresh ones.
  m_ = count;
  p_ = 0;
  apply_both(0, m_);
  const VectorX energy =
      solver::gram(S_.leftCols(m_), KS_.leftCols(m_)).diagonal();
  theta_ = solver::gram(S_.leftCols(m_), AS_.leftCols(m_)).diagonal().array() /
           energy.array();
  settled_norms_.resize(0);
  settled_theta_.resize(0);
  measure();
  if (end_ == EigenEnd::TooManyIterations && all_settled()) {
    pairs.end = EigenEnd::Converged;
  }
  pairs.theta = theta_;
  pairs.x = S_.leftCols(m_) * energy.cwiseSqrt().cwiseInverse().asDiagonal();
  pairs.residuals = residuals_.array() / energy.array().sqrt();
  return pairs;
}

EigenPairs EigenSearch::run(const solver::Columns& start) {
  Monitor& monitor =
      options_.monitor != nullptr ? *options_.monitor : silent_monitor();
  begin(start);
  const int least = start.cols() > 0 ? kEnoughToShow : 0;
  bool going = improve(m_);
  while (going && m_ > 0) {
    throw_if_stopped(monitor, "fea");
    measure();
    if (end_ == EigenEnd::NotPositive ||
        (all_settled() && (iterations_ >= least || w_ == 0))) {
      break;
    }
    if (iterations_ == options_.max_iterations) {
      end_ = EigenEnd::TooManyIterations;
      break;
    }
    ++iterations_;
    monitor.progress(
        {.stage = "fea",
         .detail = fmt::format(
             "eigenvalues: step {}, residual {:.1e}", iterations_,
             residuals_.head(std::min<Eigen::Index>(options_.count, m_))
                 .maxCoeff())});
    add_search_directions();
    going = improve(m_);
  }
  return finish();
}

}  // namespace

EigenPairs largest_eigenpairs(const EigenProblem& problem,
                              const solver::Columns& start,
                              const EigenOptions& options) {
  return EigenSearch(problem, options).run(start);
}

}  // namespace meniscus::modes
