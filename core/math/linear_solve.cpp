#include "core/math/linear_solve.h"

#include <cblas.h>
#include <cholmod.h>
#include <cmath>
#include <metis.h>
#include <mutex>
#include <omp.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/blas_threads.h"
#include "core/memory.h"
#include "core/operation_count.h"

namespace meniscus {

namespace {

using Long = SuiteSparse_long;

/// While it lives, OpenMP's regions in this thread have one thread. CHOLMOD
/// asks for four, whatever this program is to use: they came and went by the
/// thousand, and where a limit left no room for one libgomp ended the process.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) {
    omp_set_max_active_levels(0);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

/// A CHOLMOD session.
class Session {
 public:
  Session() {
    prepare_blas();
    cholmod_l_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
  }
  ~Session() { cholmod_l_finish(&common); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  cholmod_common common;
};

/// A lower triangle with CHOLMOD's 64-bit indices; values are borrowed.
struct LowerView {
  std::vector<Long> outer;
  std::vector<Long> inner;
  cholmod_sparse sparse{};
};

LowerView make_view(const SparseMatrix& lower) {
  if (!lower.isCompressed() || lower.rows() != lower.cols()) {
    throw SolverError(fmt::format(
        "symmetric factor: matrix must be square and compressed, found {} x {}",
        lower.rows(), lower.cols()));
  }
  LowerView view;
  view.outer.assign(lower.outerIndexPtr(),
                    lower.outerIndexPtr() + lower.cols() + 1);
  view.inner.assign(lower.innerIndexPtr(),
                    lower.innerIndexPtr() + lower.nonZeros());
  cholmod_sparse& s = view.sparse;
  s.nrow = s.ncol = static_cast<size_t>(lower.cols());
  s.nzmax = static_cast<size_t>(lower.nonZeros());
  s.p = view.outer.data();
  s.i = view.inner.data();
  s.x = const_cast<double*>(lower.valuePtr());  // NOLINT: CHOLMOD only reads
  s.stype = -1;
  s.itype = CHOLMOD_LONG;
  s.xtype = CHOLMOD_REAL;
  s.dtype = CHOLMOD_DOUBLE;
  s.sorted = 1;
  s.packed = 1;
  return view;
}

/// METIS seeds and draws from the C library's one random sequence: in two
/// threads at once the order would depend on their timing.
std::mutex& one_metis_at_a_time() {
  static std::mutex one;
  return one;
}

/// What CHOLMOD's status says, and what to try.
std::string status_text(int status) {
  return status == CHOLMOD_OUT_OF_MEMORY
             ? "not enough memory; fewer unknowns need less"
             : fmt::format("CHOLMOD status {}", status);
}

/// One of cholmod_solve's systems.
Eigen::MatrixXd solved_step(cholmod_factor& factor, int system,
                            const Eigen::MatrixXd& right,
                            cholmod_common& common) {
  cholmod_dense b{};
  b.nrow = factor.n;
  b.ncol = static_cast<size_t>(right.cols());
  b.nzmax = b.nrow * b.ncol;
  b.d = b.nrow;
  b.x = const_cast<double*>(right.data());  // NOLINT: CHOLMOD only reads
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_l_solve(system, &factor, &b, &common);
  if (x == nullptr) {
    throw SolverError(fmt::format("triangular solve of {} unknowns failed: {}",
                                  factor.n, status_text(common.status)));
  }
  Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(x->x), right.rows(), right.cols());
  cholmod_l_free_dense(&x, &common);
  return result;
}

/// each(column, row, value) of a supernodal L, columns ascending.
template <class Each>
void for_each_entry(const cholmod_factor& factor, const Each& each) {
  const auto* super = static_cast<const Long*>(factor.super);
  const auto* row_start = static_cast<const Long*>(factor.pi);
  const auto* value_start = static_cast<const Long*>(factor.px);
  const auto* row = static_cast<const Long*>(factor.s);
  const auto* value = static_cast<const double*>(factor.x);
  for (size_t s = 0; s < factor.nsuper; ++s) {
    const Long rows = row_start[s + 1] - row_start[s];
    for (Long c = 0; c < super[s + 1] - super[s]; ++c) {
      for (Long r = c; r < rows; ++r) {
        each(super[s] + c, row[row_start[s] + r],
             value[value_start[s] + c * rows + r]);
      }
    }
  }
}

/// Of the numeric factor and the work space, known once it is analysed.
double expected_bytes(const cholmod_factor& factor,
                      const cholmod_common& common) {
  constexpr double kNumber = sizeof(double);
  if (factor.is_super != 0) {
    return kNumber * (static_cast<double>(factor.xsize) +
                      static_cast<double>(factor.maxcsize));
  }
  return (kNumber + sizeof(Long)) * common.lnz;
}

}  // namespace

std::vector<int> nested_dissection(const SparseMatrix& lower) {
  const int n = static_cast<int>(lower.cols());
  std::vector<idx_t> start(n + 1, 0);
  for (int c = 0; c < n; ++c) {
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it) {
      if (it.row() > c) {
        ++start[c + 1];
        ++start[it.row() + 1];
      }
    }
  }
  for (int c = 0; c < n; ++c) {
    start[c + 1] += start[c];
  }
  std::vector<idx_t> neighbours(start[n]);
  std::vector<idx_t> next(start.begin(), start.end() - 1);
  for (int c = 0; c < n; ++c) {
    for (SparseMatrix::InnerIterator it(lower, c); it; ++it) {
      if (it.row() > c) {
        neighbours[next[c]++] = static_cast<idx_t>(it.row());
        neighbours[next[it.row()]++] = c;
      }
    }
  }
  std::vector<idx_t> order(n);
  std::vector<idx_t> position(n);
  if (neighbours.empty()) {  // METIS refuses a graph without edges
    for (int c = 0; c < n; ++c) {
      order[c] = c;
    }
  } else {
    const std::lock_guard lock(one_metis_at_a_time());
    idx_t count = n;
    const int status =
        METIS_NodeND(&count, start.data(), neighbours.data(), nullptr, nullptr,
                     order.data(), position.data());
    if (status != METIS_OK) {
      throw SolverError(fmt::format(
          "nested dissection of {} unknowns failed (METIS status {})", n,
          status));
    }
  }
  return {order.begin(), order.end()};
}

std::vector<int> bisected_graph(const std::vector<int>& start,
                                const std::vector<int>& neighbors, int levels) {
  const std::size_t n = start.size() - 1;
  if (levels == 0 || neighbors.empty()) {
    return std::vector<int>(n, 0);
  }
  std::vector<idx_t> xadj(start.begin(), start.end());
  std::vector<idx_t> adjacency(neighbors.begin(), neighbors.end());
  std::vector<idx_t> part(n);
  idx_t count = static_cast<idx_t>(n);
  idx_t constraints = 1;
  idx_t parts = idx_t{1} << levels;
  idx_t cut = 0;
  const std::lock_guard lock(one_metis_at_a_time());
  const int status = METIS_PartGraphRecursive(
      &count, &constraints, xadj.data(), adjacency.data(), nullptr, nullptr,
      nullptr, &parts, nullptr, nullptr, nullptr, &cut, part.data());
  if (status != METIS_OK) {
    throw SolverError(
        fmt::format("a graph of {} vertices cannot be parted (METIS status {})",
                    n, status));
  }
  return {part.begin(), part.end()};
}

std::vector<int> expand_order(const std::vector<int>& node_order, int block) {
  std::vector<int> order;
  order.reserve(node_order.size() * block);
  for (const int node : node_order) {
    for (int k = 0; k < block; ++k) {
      order.push_back(node * block + k);
    }
  }
  return order;
}

struct SymmetricFactor::Impl {
  Session session;
  FactorKind kind = FactorKind::Cholesky;
  cholmod_factor* factor = nullptr;  // null: of no unknowns
  int failed_column = -1;
  int negative_pivots = 0;
  double factor_work = 0.0;  // operations of a factorisation
  double factor_entries = 0.0;

  ~Impl() { cholmod_l_free_factor(&factor, &session.common); }
};

SymmetricFactor::SymmetricFactor(const SparseMatrix& lower, FactorKind kind,
                                 const std::vector<int>& order)
    : impl_(std::make_unique<Impl>()) {
  LowerView view = make_view(lower);
  impl_->kind = kind;
  if (lower.cols() == 0) {
    return;  // CHOLMOD refuses arrays of no length
  }
  cholmod_common& common = impl_->session.common;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  common.postorder = 1;
  common.supernodal =
      kind == FactorKind::Cholesky ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
  if (kind == FactorKind::Indefinite) {
    common.final_ll = 0;
  }
  const std::vector<int> found =
      order.empty() ? nested_dissection(lower) : order;
  std::vector<Long> permutation(found.begin(), found.end());
  impl_->factor = cholmod_l_analyze_p(&view.sparse, permutation.data(), nullptr,
                                      0, &common);
  if (impl_->factor == nullptr) {
    throw SolverError(
        fmt::format("analysis of a sparse matrix with {} unknowns failed: {}",
                    lower.cols(), status_text(common.status)));
  }
  impl_->factor_work = common.fl;
  impl_->factor_entries = common.lnz;
}

SymmetricFactor::~SymmetricFactor() = default;
SymmetricFactor::SymmetricFactor(SymmetricFactor&&) noexcept = default;
SymmetricFactor& SymmetricFactor::operator=(SymmetricFactor&&) noexcept =
    default;

bool SymmetricFactor::factorize(const SparseMatrix& lower) {
  LowerView view = make_view(lower);
  if (impl_->factor == nullptr) {
    return true;
  }
  cholmod_common& common = impl_->session.common;
  cholmod_factor& factor = *impl_->factor;
  if (factor.xtype == CHOLMOD_PATTERN) {  // not factorised before
    require_memory(expected_bytes(factor, common),
                   fmt::format("a sparse factor of {} unknowns", lower.cols()),
                   "fewer unknowns need less");
  }
  impl_->failed_column = -1;
  impl_->negative_pivots = 0;
  {
    const OneThread here;
    cholmod_l_factorize(&view.sparse, &factor, &common);
  }
  count_operations(impl_->factor_work);
  if (common.status == CHOLMOD_OUT_OF_MEMORY ||
      common.status == CHOLMOD_TOO_LARGE) {
    throw SolverError(fmt::format(
        "factorisation of {} unknowns needs more memory than there is",
        lower.cols()));
  }
  if (common.status < CHOLMOD_OK) {
    throw SolverError(
        fmt::format("factorisation failed (CHOLMOD status {})", common.status));
  }
  if (factor.minor < factor.n) {
    const auto* permutation = static_cast<const Long*>(factor.Perm);
    impl_->failed_column = static_cast<int>(permutation[factor.minor]);
    return false;
  }
  if (impl_->kind == FactorKind::Indefinite) {
    // Simplicial L D L^T: D stands on the diagonal, first in each column.
    const auto* start = static_cast<const Long*>(factor.p);
    const auto* value = static_cast<const double*>(factor.x);
    for (size_t c = 0; c < factor.n; ++c) {
      const double pivot = value[start[c]];
      if (!std::isfinite(pivot) || pivot == 0.0) {
        impl_->failed_column =
            static_cast<int>(static_cast<const Long*>(factor.Perm)[c]);
        return false;
      }
      impl_->negative_pivots += pivot < 0.0 ? 1 : 0;
    }
  }
  return true;
}

void SymmetricFactor::check_rows(const Eigen::MatrixXd& right) const {
  const size_t n = impl_->factor == nullptr ? 0 : impl_->factor->n;
  if (static_cast<size_t>(right.rows()) != n) {
    throw SolverError(fmt::format(
        "solve: right side has {} rows, the factor {}", right.rows(), n));
  }
}

void SymmetricFactor::count_solve(Eigen::Index columns) const {
  // Per entry of L below the diagonal four, per pivot two, of each column.
  count_operations((4.0 * impl_->factor_entries -
                    2.0 * static_cast<double>(impl_->factor->n)) *
                   static_cast<double>(columns));
}

Eigen::MatrixXd SymmetricFactor::solve(const Eigen::MatrixXd& right) const {
  check_rows(right);
  if (right.size() == 0) {
    return right;
  }
  count_solve(right.cols());
  Session session;  // own workspace: solve may run in several threads
  return solved_step(*impl_->factor, CHOLMOD_A, right, session.common);
}

Eigen::MatrixXd SymmetricFactor::solve_leading(const Eigen::MatrixXd& right,
                                               int count) const {
  check_rows(right);
  if (right.size() == 0) {
    return right;
  }
  count_solve(right.cols());
  Session session;
  const auto step = [&](int system, const Eigen::MatrixXd& b) {
    return solved_step(*impl_->factor, system, b, session.common);
  };
  Eigen::MatrixXd b = right;
  b.bottomRows(count).setZero();
  Eigen::MatrixXd y = step(CHOLMOD_Pt, step(CHOLMOD_L, step(CHOLMOD_P, b)));
  y.bottomRows(count).setZero();
  return step(CHOLMOD_Pt, step(CHOLMOD_Lt, step(CHOLMOD_P, y)));
}

Eigen::MatrixXd SymmetricFactor::schur_complement(int count) const {
  const cholmod_factor& factor = *impl_->factor;
  const auto* order = static_cast<const Long*>(factor.Perm);
  const auto n = static_cast<Long>(factor.n);
  const Long leading = n - count;
  std::vector<Long> last;  // in their order of elimination
  std::vector<int> place(factor.n, -1);
  for (Long k = 0; k < n; ++k) {
    if (order[k] >= leading) {
      place[k] = static_cast<int>(last.size());
      last.push_back(order[k] - leading);
    }
  }
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(count, count);
  for_each_entry(factor, [&](Long column, Long row, double value) {
    if (place[column] >= 0 && place[row] >= 0) {
      L(place[row], place[column]) = value;
    }
  });
  prepare_blas();
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(count, count);
  if (count > 0) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, count, count, 1.0,
                L.data(), count, 0.0, product.data(), count);
  }
  count_operations(static_cast<double>(count) * count * count);
  for (int c = 0; c < count; ++c) {  // two arrays are enough
    for (int r = c; r < count; ++r) {
      L(last[r], last[c]) = L(last[c], last[r]) = product(r, c);
    }
  }
  return L;
}

int SymmetricFactor::failed_column() const { return impl_->failed_column; }

int SymmetricFactor::negative_pivots() const { return impl_->negative_pivots; }

long long SymmetricFactor::entries() const {
  if (impl_->factor == nullptr) {
    return 0;
  }
  const cholmod_factor& factor = *impl_->factor;
  return static_cast<long long>(factor.is_super != 0 ? factor.xsize
                                                     : factor.nzmax);
}

}  // namespace meniscus
