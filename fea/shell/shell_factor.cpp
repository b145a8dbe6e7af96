#include "fea/shell/shell_factor.h"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <omp.h>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/math/partial_cholesky.h"
#include "core/memory.h"
#include "core/parallel_for.h"

namespace meniscus::shell {

namespace {

/// Substructures that are condensed before their wholes are, one a thread.
int leaves_at_once() { return std::max(4, omp_get_max_threads()); }
constexpr double kDenseShare = 0.25;  // ShellFactorOptions::kept_bytes

int levels_for(int unknowns, const ShellFactorOptions& options) {
  int levels = 0;
  while (levels < options.most_levels &&
         unknowns > options.unknowns * (2 << levels)) {
    ++levels;
  }
  return levels;
}

[[noreturn]] void throw_not_definite(int unknowns) {
  throw SolverError(fmt::format(
      "the stiffness matrix of a shell of {} unknowns is not positive "
      "definite: facets are nearly without area, or thicknesses far apart",
      unknowns));
}

}  // namespace

/// A substructure's own equations.
struct ShellFactor::Leaf {
  std::vector<int> own;       // unknowns of the whole, as those of the factor
  std::vector<int> boundary;  // that stand behind them
  SparseMatrix coupling;      // rows: boundary, columns: own
  SymmetricFactor factor;     // of both, the boundary's diagonal raised
  VectorX raised;             // by this
};

/// A cut's.
struct ShellFactor::Front {
  std::vector<int> own;  // unknowns
  std::vector<int> boundary;
  StoredMatrix L;  // rows: own, boundary; columns: own
};

/// Right sides on their way to solutions.
struct ShellFactor::Columns {
  Columns(const Eigen::MatrixXd& right_sides, int leaves)
      : right(right_sides), x(right_sides), passed(leaves) {}

  const Eigen::MatrixXd& right;
  Eigen::MatrixXd x;
  std::vector<Eigen::MatrixXd> passed;  // by leaves to their boundaries
};

namespace {

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& all, const std::vector<int>& own,
                        const std::vector<int>& boundary) {
  Eigen::MatrixXd b(own.size() + boundary.size(), all.cols());
  b << all(own, Eigen::all), all(boundary, Eigen::all);
  return b;
}

}  // namespace

ShellFactor::ShellFactor(const ShellMesh& mesh, const ShellFreedom& freedom,
                         MatrixOfFacet matrix,
                         const ShellFactorOptions& options,
                         Eigen::MatrixXd* right)
    : mesh_(mesh),
      freedom_(freedom),
      matrix_(std::move(matrix)),
      cut_(cut_shell(mesh, levels_for(freedom.unknowns(), options))),
      monitor_(options.monitor == nullptr ? silent_monitor()
                                          : *options.monitor),
      kept_bytes_(options.kept_bytes < 0.0 ? 0.5 * available_memory()
                                           : options.kept_bytes),
      kept_(cut_.leaf_count()),
      fronts_(cut_.parts.size()),
      schur_(cut_.parts.size()) {
  std::optional<Columns> columns;
  if (right != nullptr) {
    check_rows(*right);
    columns.emplace(*right, cut_.leaf_count());
  }
  const int leaves = cut_.leaf_count();
  for_leaves(
      "condensed",
      [&](int leaf) { condense_leaf(leaf, columns ? &*columns : nullptr); },
      [&] {  // wholes of which both halves are there, from below
        for (int whole = leaves - 1; whole > 0; --whole) {
          if (schur_[2 * whole] && schur_[2 * whole + 1]) {
            condense_halves(whole);
          }
        }
      });
  if (columns) {
    *right = solve_cuts(*columns);
  }
}

ShellFactor::~ShellFactor() = default;

std::vector<int> ShellFactor::unknowns_of(const std::vector<int>& nodes) const {
  std::vector<int> unknowns;
  for (const int node : nodes) {
    for (int k = 0; k < freedom_.free_count(node); ++k) {
      unknowns.push_back(freedom_.first_unknown(node) + k);
    }
  }
  return unknowns;
}

ShellFactor::Leaf ShellFactor::factored(int leaf) const {
  const Part& part = cut_.parts[cut_.part_of(leaf)];
  const std::vector<int>& facets = cut_.facets[leaf];
  std::vector<int> nodes = part.own;
  nodes.insert(nodes.end(), part.boundary.begin(), part.boundary.end());
  std::vector<int> local(mesh_.nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    local[nodes[i]] = static_cast<int>(i);
  }
  ShellMesh mesh;
  mesh.nodes.resize(nodes.size());  // the assembly does not read places
  for (const int facet : facets) {
    std::array<int, 6> own{};
    for (int k = 0; k < kNodes; ++k) {
      own[k] = local[mesh_.facets[facet][k]];
    }
    mesh.facets.push_back(own);
  }
  const ShellFreedom freedom = freedom_.of(nodes);
  const ShellAssembly assembly(mesh, freedom);
  SparseMatrix K =
      assembly.sum([&](int facet) { return matrix_(facets[facet]); });
  const std::vector<int> own = unknowns_of(part.own);
  const std::vector<int> boundary = unknowns_of(part.boundary);
  const auto inside = static_cast<int>(own.size());
  const auto outside = static_cast<int>(boundary.size());
  SparseMatrix coupling = K.block(inside, 0, outside, inside);
  const VectorX raised = K.diagonal().tail(outside);
  for (int k = 0; k < outside; ++k) {
    K.coeffRef(inside + k, inside + k) += raised[k];
  }
  SymmetricFactor factor(
      K, FactorKind::Cholesky,
      assembly.elimination_order(static_cast<int>(part.boundary.size())));
  if (!factor.factorize(K)) {
    throw_not_definite(freedom_.unknowns());
  }
  return {own, boundary, coupling, std::move(factor), raised};
}

const ShellFactor::Leaf& ShellFactor::leaf_of(
    int leaf, std::unique_ptr<Leaf>& made) const {
  if (kept_[leaf]) {
    return *kept_[leaf];
  }
  made = std::make_unique<Leaf>(factored(leaf));
  return *made;
}

template <class Each, class After>
void ShellFactor::for_leaves(const char* work, const Each& each,
                             const After& after) const {
  const int leaves = cut_.leaf_count();
  const int batch = leaves_at_once();
  for (int first = 0; first < leaves; first += batch) {
    if (cut_.levels > 0) {
      throw_if_stopped(monitor_, "fea");
      monitor_.progress({.stage = "fea",
                         .detail = fmt::format("substructures {}: {} of {}",
                                               work, first, leaves),
                         .fraction = static_cast<double>(first) / leaves});
    }
    parallel_for(std::min(batch, leaves - first),
                 [&](std::ptrdiff_t k) { each(first + static_cast<int>(k)); });
    after();
  }
}

void ShellFactor::condense_leaf(int leaf, Columns* columns) {
  auto own = std::make_unique<Leaf>(factored(leaf));
  const auto outside = static_cast<int>(own->boundary.size());
  if (cut_.levels > 0) {
    Eigen::MatrixXd S = own->factor.schur_complement(outside);
    S.diagonal() -= own->raised;
    schur_[cut_.part_of(leaf)].emplace(stored(std::move(S)));
  }
  if (columns != nullptr) {
    eliminate(leaf, *own, *columns);
  }
  const double bytes =
      sizeof(double) * static_cast<double>(own->factor.entries());
  if (cut_.levels == 0 || bytes < kept_bytes_ / cut_.leaf_count()) {
    kept_[leaf] = std::move(own);
  }
}

StoredMatrix ShellFactor::stored(Eigen::MatrixXd matrix) {
  const double bytes = sizeof(double) * static_cast<double>(matrix.size());
  bool spill = false;
  {
    const std::scoped_lock lock(dense_mutex_);
    spill = dense_bytes_ + bytes > kDenseShare * kept_bytes_;
    dense_bytes_ += spill ? 0.0 : bytes;
  }
  return {std::move(matrix), spill};
}

void ShellFactor::condense_halves(int part) {
  const std::vector<int> own = unknowns_of(cut_.parts[part].own);
  const std::vector<int> boundary = unknowns_of(cut_.parts[part].boundary);
  std::vector<int> place(freedom_.unknowns(), -1);
  int next = 0;
  for (const auto& list : {own, boundary}) {
    for (const int unknown : list) {
      place[unknown] = next++;
    }
  }
  const auto count = static_cast<int>(own.size());
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(next, count);
  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(next - count, next - count);
  for (const int half : {2 * part, 2 * part + 1}) {
    const std::vector<int> at = unknowns_of(cut_.parts[half].boundary);
    schur_[half]->for_each_block([&](Eigen::Index first, const auto& S) {
      for (Eigen::Index k = 0; k < S.cols(); ++k) {
        const Eigen::Index c = first + k;
        for (Eigen::Index r = c; r < S.rows(); ++r) {
          const auto [column, row] = std::minmax(place[at[r]], place[at[c]]);
          (column < count ? L(row, column)
                          : rest(row - count, column - count)) += S(r, k);
        }
      }
    });
    dense_bytes_ -= schur_[half]->bytes();
    schur_[half].reset();
  }
  if (!eliminate_leading(L, rest)) {
    throw_not_definite(freedom_.unknowns());
  }
  fronts_[part] =
      std::make_unique<Front>(Front{own, boundary, stored(std::move(L))});
  schur_[part].emplace(stored(std::move(rest)));
}

void ShellFactor::check_rows(const Eigen::MatrixXd& right) const {
  if (right.rows() != freedom_.unknowns()) {
    throw SolverError(
        fmt::format("solve: right side has {} rows, the shell {} unknowns",
                    right.rows(), freedom_.unknowns()));
  }
}

/// A leaf's unknowns as if its boundary were held, and what that leaves there.
void ShellFactor::eliminate(int leaf, const Leaf& own, Columns& columns) const {
  const auto outside = static_cast<int>(own.boundary.size());
  const Eigen::MatrixXd z =
      cut_.levels == 0
          ? own.factor.solve(columns.right)
          : own.factor
                .solve_leading(rows_of(columns.right, own.own, own.boundary),
                               outside)
                .topRows(own.own.size());
  columns.passed[leaf] = own.coupling * z;
  columns.x(own.own, Eigen::all) = z;  // each its own rows
}

Eigen::MatrixXd ShellFactor::solve(const Eigen::MatrixXd& right) const {
  check_rows(right);
  Columns columns(right, cut_.leaf_count());
  for_leaves(
      "solved",
      [&](int leaf) {
        std::unique_ptr<Leaf> made;
        eliminate(leaf, leaf_of(leaf, made), columns);
      },
      [] {});
  return solve_cuts(columns);
}

/// The cuts' unknowns of what leaves left there, then the leaves' own.
Eigen::MatrixXd ShellFactor::solve_cuts(Columns& columns) const {
  Eigen::MatrixXd& x = columns.x;
  if (cut_.levels == 0) {
    return std::move(x);
  }
  const int leaves = cut_.leaf_count();
  for (int k = 0; k < leaves; ++k) {
    x(unknowns_of(cut_.parts[cut_.part_of(k)].boundary), Eigen::all) -=
        columns.passed[k];
  }
  for (int part = leaves - 1; part > 0; --part) {
    const Front& front = *fronts_[part];
    Eigen::MatrixXd b = rows_of(x, front.own, front.boundary);
    Eigen::MatrixXd read;
    solve_leading_lower(front.L.get(read), b);
    x(front.own, Eigen::all) = b.topRows(front.own.size());
    x(front.boundary, Eigen::all) = b.bottomRows(front.boundary.size());
  }
  for (int part = 1; part < leaves; ++part) {
    const Front& front = *fronts_[part];
    Eigen::MatrixXd b = rows_of(x, front.own, front.boundary);
    Eigen::MatrixXd read;
    solve_leading_upper(front.L.get(read), b);
    x(front.own, Eigen::all) = b.topRows(front.own.size());
  }
  for_leaves(
      "solved back",
      [&](int k) {
        std::unique_ptr<Leaf> made;
        const Leaf& leaf = leaf_of(k, made);
        Eigen::MatrixXd b = Eigen::MatrixXd::Zero(
            leaf.own.size() + leaf.boundary.size(), x.cols());
        b.topRows(leaf.own.size()) =
            leaf.coupling.transpose() * x(leaf.boundary, Eigen::all);
        x(leaf.own, Eigen::all) -=
            leaf.factor.solve_leading(b, static_cast<int>(leaf.boundary.size()))
                .topRows(leaf.own.size());
      },
      [] {});
  return std::move(x);
}

}  // namespace meniscus::shell
