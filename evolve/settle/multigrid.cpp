#include "evolve/settle/multigrid.h"

#include <algorithm>
#include <cmath>

#include "core/operation_count.h"

namespace meniscus::settle {

namespace {

constexpr int kShiftsTried = 24;
constexpr double kShiftMargin = 2.0;

/// Corners of the four children as pairs of the parent's corners.
constexpr std::array<std::array<std::array<int, 2>, 3>, 4> kChildren = {
    {{{{0, 0}, {0, 1}, {2, 0}}},
     {{{0, 1}, {1, 1}, {1, 2}}},
     {{{2, 0}, {1, 2}, {2, 2}}},
     {{{0, 1}, {1, 2}, {2, 0}}}}};

/// Of every child's weights (three in five are not zero), its rows by them, and
/// the weights by those.
double gather_work(const std::vector<int>& coarse,
                   const std::vector<int>& fine) {
  double work = 0.0;
  for (std::size_t f = 0; f + 1 < coarse.size(); ++f) {
    const double c = coarse[f + 1] - coarse[f];
    for (std::size_t g = 4 * f; g < 4 * f + 4; ++g) {
      const double n = fine[g + 1] - fine[g];
      work += 6.6 * n * c + 2.0 * n * n * c + c * (c + 1.0) * (n + 0.5);
    }
  }
  return work;
}

}  // namespace

bool is_nested(const energy::FilmEnergy& coarse, const energy::FilmEnergy& fine,
               const std::vector<Edge>& parents) {
  if (fine.facets().size() != 4 * coarse.facets().size()) {
    return false;
  }
  const int old = coarse.space().vertex_count();
  if (fine.space().vertex_count() != old + static_cast<int>(parents.size())) {
    return false;
  }
  for (std::size_t f = 0; f < coarse.facets().size(); ++f) {
    for (int c = 0; c < 4; ++c) {
      for (int k = 0; k < 3; ++k) {
        const auto [p, q] = kChildren[c][k];
        const int a = coarse.facets()[f][p];
        const int b = coarse.facets()[f][q];
        const int v = fine.facets()[4 * f + c][k];
        const bool fits = p == q
                              ? v == a
                              : v >= old && (parents[v - old] == Edge{a, b} ||
                                             parents[v - old] == Edge{b, a});
        if (!fits) {
          return false;
        }
      }
    }
  }
  for (int v = 0; v < old; ++v) {
    if (coarse.space().rank(v) != fine.space().rank(v)) {
      return false;
    }
  }
  return true;
}

struct FilmMultigrid::Level {
  // Full symmetric matrix by rows; the diagonal apart, inverted.
  std::vector<int> start;
  std::vector<int> column;
  std::vector<int> lower_slot;  // entry of pattern() -> entry below diagonal
  std::vector<int> upper_slot;  // and above it; -1: the diagonal
  std::vector<float> value;
  std::vector<float> inverse_diagonal;
  // Interpolation from the coarser level, by rows of unknowns.
  std::vector<int> p_start;
  std::vector<int> p_column;
  std::vector<float> p_value;
  Points directions;
  VectorX metric;
  // Work vectors of the cycle.
  mutable std::vector<float> x;
  mutable std::vector<float> right;

  explicit Level(const energy::FilmEnergy& energy);
  void take(const SparseMatrix& lower, double shift, std::vector<double>* full);
  void sweep_down(bool from_zero) const;
  void sweep_up() const;
};

FilmMultigrid::Level::Level(const energy::FilmEnergy& energy) {
  const SparseMatrix& lower = energy.pattern();
  const int n = energy.unknowns();
  const int* outer = lower.outerIndexPtr();
  const int* inner = lower.innerIndexPtr();
  start.assign(n + 1, 0);
  for (int b = 0; b < n; ++b) {
    for (int k = outer[b]; k < outer[b + 1]; ++k) {
      if (inner[k] != b) {
        ++start[b + 1];
        ++start[inner[k] + 1];
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    start[i + 1] += start[i];
  }
  column.resize(start[n]);
  value.resize(start[n]);
  inverse_diagonal.resize(n);
  lower_slot.assign(outer[n], -1);
  upper_slot.assign(outer[n], -1);
  // Columns ascend within each row: below-diagonal entries of row a come in
  // order of b, and all of them before those above.
  std::vector<int> at(start.begin(), start.end() - 1);
  for (int b = 0; b < n; ++b) {
    for (int k = outer[b]; k < outer[b + 1]; ++k) {
      if (const int a = inner[k]; a != b) {
        lower_slot[k] = at[a];
        column[at[a]++] = b;
      }
    }
  }
  for (int b = 0; b < n; ++b) {
    for (int k = outer[b]; k < outer[b + 1]; ++k) {
      if (inner[k] != b) {
        upper_slot[k] = at[b];
        column[at[b]++] = inner[k];
      }
    }
  }
  x.resize(n);
  right.resize(n);
}

void FilmMultigrid::Level::take(const SparseMatrix& lower, double shift,
                                std::vector<double>* full) {
  const int n = static_cast<int>(lower.cols());
  const int* outer = lower.outerIndexPtr();
  const double* from = lower.valuePtr();
  if (full != nullptr) {
    full->resize(column.size() + n);
  }
  for (int b = 0; b < n; ++b) {
    for (int k = outer[b]; k < outer[b + 1]; ++k) {
      if (lower_slot[k] < 0) {
        inverse_diagonal[b] =
            static_cast<float>(1.0 / (from[k] + shift * metric[b]));
        if (full != nullptr) {
          (*full)[column.size() + b] = from[k];
        }
        continue;
      }
      value[lower_slot[k]] = value[upper_slot[k]] = static_cast<float>(from[k]);
      if (full != nullptr) {
        (*full)[lower_slot[k]] = (*full)[upper_slot[k]] = from[k];
      }
    }
  }
}

void FilmMultigrid::Level::sweep_down(bool from_zero) const {
  const int n = static_cast<int>(x.size());
  for (int i = 0; i < n; ++i) {
    float sum = right[i];
    for (int k = start[i]; k < start[i + 1]; ++k) {
      if (from_zero && column[k] > i) {
        break;
      }
      sum -= value[k] * x[column[k]];
    }
    x[i] = sum * inverse_diagonal[i];
  }
}

void FilmMultigrid::Level::sweep_up() const {
  for (int i = static_cast<int>(x.size()) - 1; i >= 0; --i) {
    float sum = right[i];
    for (int k = start[i]; k < start[i + 1]; ++k) {
      sum -= value[k] * x[column[k]];
    }
    x[i] = sum * inverse_diagonal[i];
  }
}

FilmMultigrid::FilmMultigrid(const std::vector<FilmLevel>& levels)
    : chain_(levels) {
  for (const FilmLevel& level : chain_) {
    levels_.push_back(std::make_unique<Level>(*level.energy));
  }
  coarsest_ = std::make_unique<SymmetricFactor>(
      chain_.front().energy->pattern(), FactorKind::Cholesky,
      chain_.front().energy->order());
}

FilmMultigrid::~FilmMultigrid() = default;

/// Interpolation weights: a vertex moves with the mean of its edge's ends,
/// taken along its own directions.
void FilmMultigrid::transfer_weights(std::size_t fine) {
  Level& level = *levels_[fine];
  Level& below = *levels_[fine - 1];
  const energy::FilmSpace& space = chain_[fine].energy->space();
  const energy::FilmSpace& coarse = chain_[fine - 1].energy->space();
  const int old = coarse.vertex_count();
  // Old vertices keep their directions (injection), so that coarse heights are
  // fine ones there.
  below.directions.resize(coarse.unknowns());
  for (int v = 0; v < old; ++v) {
    for (int r = 0; r < coarse.rank(v); ++r) {
      below.directions[coarse.first(v) + r] =
          level.directions[space.first(v) + r];
    }
  }
  // Rows of P: 1 at an old vertex; at a midpoint half of n_fine . n_coarse for
  // each direction of both ends.
  level.p_start.assign(1, 0);
  level.p_start.reserve(space.unknowns() + 1);
  level.p_column.clear();
  level.p_value.clear();
  for (int i = 0; i < space.unknowns(); ++i) {
    const int v = space.vertices()[i];
    if (v < old) {
      level.p_column.push_back(coarse.first(v) + i - space.first(v));
      level.p_value.push_back(1.0F);
    } else {
      for (const int parent : chain_[fine].parents[v - old]) {
        for (int r = 0; r < coarse.rank(parent); ++r) {
          const int j = coarse.first(parent) + r;
          level.p_column.push_back(j);
          level.p_value.push_back(static_cast<float>(
              0.5 * level.directions[i].dot(below.directions[j])));
        }
      }
    }
    level.p_start.push_back(static_cast<int>(level.p_column.size()));
  }
  // A mean takes two dot products with what stands before them; a vertex of the
  // coarse level stays as it is.
  const auto entries = static_cast<double>(level.p_value.size());
  count_operations(6.0 * (entries - coarse.unknowns()) + 2.0 * entries);
  // The coarse metric, lumped: |P|' times the fine one.
  below.metric = VectorX::Zero(coarse.unknowns());
  for (int i = 0; i < space.unknowns(); ++i) {
    for (int k = level.p_start[i]; k < level.p_start[i + 1]; ++k) {
      below.metric[level.p_column[k]] +=
          std::abs(level.p_value[k]) * level.metric[i];
    }
  }
}

void FilmMultigrid::gather(std::size_t fine,
                           const std::vector<double>& fine_elements,
                           std::vector<double>& coarse_elements) const {
  const energy::FilmEnergy& coarse = *chain_[fine - 1].energy;
  const energy::FilmEnergy& above = *chain_[fine].energy;
  const Points& d_coarse = levels_[fine - 1]->directions;
  const Points& d_fine = levels_[fine]->directions;
  coarse_elements.assign(coarse.element_start().back(), 0.0);
  std::array<std::array<double, 9>, 9> p{};
  std::array<std::array<double, 9>, 9> kp{};
  count_operations(gather_work(coarse.corner_start(), above.corner_start()));
  // The Galerkin matrix P' K P, facet by facet: a coarse facet's element is the
  // sum over its four children of p' k p.
  for (std::size_t f = 0; f < coarse.facets().size(); ++f) {
    const int c0 = coarse.corner_start()[f];
    const int nc = coarse.corner_start()[f + 1] - c0;
    if (nc == 0) {
      continue;
    }
    double* out = &coarse_elements[coarse.element_start()[f]];
    for (int child = 0; child < 4; ++child) {
      const std::size_t g = 4 * f + child;
      const int f0 = above.corner_start()[g];
      const int nf = above.corner_start()[g + 1] - f0;
      for (int j = 0; j < nf; ++j) {
        // p: a child's corner is a corner (weights 1/2 + 1/2) or the middle of
        // an edge of its parent, projected on the directions.
        const energy::FilmEnergy::Corner& at = above.corners()[f0 + j];
        const auto [a, b] = kChildren[child][at.corner];
        for (int i = 0; i < nc; ++i) {
          const energy::FilmEnergy::Corner& from = coarse.corners()[c0 + i];
          const double w = 0.5 * (from.corner == a) + 0.5 * (from.corner == b);
          p[j][i] = w == 0.0
                        ? 0.0
                        : w * d_fine[at.unknown].dot(d_coarse[from.unknown]);
        }
      }
      // k p from the packed lower triangle of the symmetric k.
      const double* k = &fine_elements[above.element_start()[g]];
      for (int j = 0; j < nf; ++j) {
        for (int i = 0; i < nc; ++i) {
          kp[j][i] = 0.0;
        }
      }
      for (int j = 0; j < nf; ++j) {
        for (int l = 0; l <= j; ++l, ++k) {
          for (int i = 0; i < nc; ++i) {
            kp[j][i] += *k * p[l][i];
          }
          if (l != j) {
            for (int i = 0; i < nc; ++i) {
              kp[l][i] += *k * p[j][i];
            }
          }
        }
      }
      // The lower triangle of p' (k p) is added to the coarse element.
      int slot = 0;
      for (int i = 0; i < nc; ++i) {
        for (int l = 0; l <= i; ++l, ++slot) {
          double sum = 0.0;
          for (int j = 0; j < nf; ++j) {
            sum += p[j][i] * kp[j][l];
          }
          out[slot] += sum;
        }
      }
    }
  }
}

bool FilmMultigrid::factor_coarsest(const SparseMatrix& matrix,
                                    double least_shift) {
  const VectorX& metric = levels_.front()->metric;
  const auto works = [&](double shift) {
    SparseMatrix shifted = matrix;
    for (int i = 0; i < shifted.cols(); ++i) {
      shifted.valuePtr()[shifted.outerIndexPtr()[i]] += shift * metric[i];
    }
    return coarsest_->factorize(shifted);
  };
  shift_ = least_shift;
  if (works(shift_)) {
    return true;
  }
  const double trace = matrix.diagonal().cwiseAbs().sum();
  for (int attempt = 0; attempt < kShiftsTried; ++attempt) {
    shift_ = std::max(2.0 * shift_, 1e-4 * trace / metric.sum());
    if (works(shift_)) {
      // Finer levels reach lower eigenvalues: keep away from zero.
      shift_ *= kShiftMargin;
      return works(shift_);
    }
  }
  return false;
}

bool FilmMultigrid::refresh(const Points& directions,
                            const std::vector<double>& elements,
                            const VectorX& metric, double least_shift) {
  const std::size_t finest = levels_.size() - 1;
  levels_[finest]->directions = directions;
  levels_[finest]->metric = metric;
  std::vector<SparseMatrix> matrices(levels_.size());
  std::vector<double> now = elements;
  for (std::size_t l = finest;; --l) {
    const energy::FilmEnergy& energy = *chain_[l].energy;
    matrices[l] = energy.pattern();
    energy.assemble(now, matrices[l]);
    if (l == 0) {
      break;
    }
    transfer_weights(l);
    std::vector<double> coarser;
    gather(l, now, coarser);
    now = std::move(coarser);
  }
  if (!factor_coarsest(matrices.front(), least_shift)) {
    return false;
  }
  for (std::size_t l = 1; l <= finest; ++l) {
    levels_[l]->take(matrices[l], shift_,
                     l == finest ? &fine_values_ : nullptr);
  }
  if (finest == 0) {
    levels_[0]->take(matrices[0], shift_, &fine_values_);
  }
  return true;
}

VectorX FilmMultigrid::multiply(const VectorX& x) const {
  const Level& level = *levels_.back();
  const auto n = static_cast<int>(x.size());
  const double* diagonal = fine_values_.data() + level.column.size();
  count_operations(n + 2.0 * static_cast<double>(level.column.size()));
  VectorX y(n);
  for (int i = 0; i < n; ++i) {
    double sum = diagonal[i] * x[i];
    for (int k = level.start[i]; k < level.start[i + 1]; ++k) {
      sum += fine_values_[k] * x[level.column[k]];
    }
    y[i] = sum;
  }
  return y;
}

void FilmMultigrid::cycle(std::size_t l) const {
  const Level& level = *levels_[l];
  const auto n = static_cast<int>(level.x.size());
  if (l == 0) {
    VectorX right(n);
    for (int i = 0; i < n; ++i) {
      right[i] = level.right[i];
    }
    const VectorX found = coarsest_->solve(right);
    for (int i = 0; i < n; ++i) {
      level.x[i] = static_cast<float>(found[i]);
    }
    return;
  }
  const Level& below = *levels_[l - 1];
  // Two sweeps over all entries, the residual over half of them, two transfers.
  count_operations(5.0 * static_cast<double>(level.column.size()) +
                   4.0 * static_cast<double>(level.p_value.size()) + 2.0 * n);
  level.sweep_down(true);
  std::fill(below.right.begin(), below.right.end(), 0.0F);
  for (int i = 0; i < n; ++i) {
    // After a sweep down the residual is only what lies above the diagonal.
    float r = 0.0F;
    for (int k = level.start[i + 1] - 1;
         k >= level.start[i] && level.column[k] > i; --k) {
      r -= level.value[k] * level.x[level.column[k]];
    }
    for (int k = level.p_start[i]; k < level.p_start[i + 1]; ++k) {
      below.right[level.p_column[k]] += level.p_value[k] * r;
    }
  }
  cycle(l - 1);
  for (int i = 0; i < n; ++i) {
    float sum = level.x[i];
    for (int k = level.p_start[i]; k < level.p_start[i + 1]; ++k) {
      sum += level.p_value[k] * below.x[level.p_column[k]];
    }
    level.x[i] = sum;
  }
  level.sweep_up();
}

VectorX FilmMultigrid::precondition(const VectorX& right) const {
  const Level& level = *levels_.back();
  const auto n = static_cast<int>(right.size());
  // Scaled, so that single precision holds tiny residuals.
  const double size = n > 0 ? right.cwiseAbs().maxCoeff() : 0.0;
  if (!(size > 0.0)) {
    return VectorX::Zero(n);
  }
  for (int i = 0; i < n; ++i) {
    level.right[i] = static_cast<float>(right[i] / size);
  }
  cycle(levels_.size() - 1);
  count_operations(2.0 * n);
  VectorX result(n);
  for (int i = 0; i < n; ++i) {
    result[i] = size * level.x[i];
  }
  return result;
}

VectorX FilmMultigrid::prolong(const VectorX& coarse) const {
  VectorX now = coarse;
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const Level& level = *levels_[l];
    VectorX next(static_cast<Eigen::Index>(level.x.size()));
    for (Eigen::Index i = 0; i < next.size(); ++i) {
      double sum = 0.0;
      for (int k = level.p_start[i]; k < level.p_start[i + 1]; ++k) {
        sum += level.p_value[k] * now[level.p_column[k]];
      }
      next[i] = sum;
    }
    now = std::move(next);
  }
  return now;
}

}  // namespace meniscus::settle
