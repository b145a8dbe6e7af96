#include "fea/modes/eigen_shapes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "fea/modes/pin_space.h"
#include "fea/solver/multi_vector.h"

namespace meniscus::modes {

namespace {

/// Iterations after which a factor is quicker.
constexpr int kSlow = 60;

Eigen::Index free_directions(const equations::ElasticOperator& op,
                             const PinSpace& space) {
  double free = 3.0 * op.table->pattern.nodes;
  for (const Mat3& P : op.freedom.projector) {
    free -= 3.0 - P.trace();
  }
  return std::lround(free) + space.motions();
}

/// By blocks of nodes, on the directions that supports and pins leave.
class ElasticProducts {
 public:
  ElasticProducts(const equations::ElasticOperator& op, const PinSpace& space)
      : op_(op), space_(space), products_(op.table->pattern, space.freedom()) {}

  /// Must not outlive this and what it is given.
  EigenProblem problem(const solver::NodalMatrix& A,
                       const solver::Preconditioner& preconditioner) {
    return {.rows = 3L * op_.table->pattern.nodes,
            .dimension = free_directions(op_, space_),
            .K = product(op_.K),
            .A = product(A),
            .preconditioner =
                [this, &preconditioner](const solver::ColumnsIn& r,
                                        const solver::ColumnsOut& z) {
                  precondition(preconditioner, r, z);
                },
            .project =
                [this](const solver::ColumnsOut& v) {
                  solver::project(space_.freedom(), v);
                  space_.project(v);
                }};
  }

 private:
  template <class Matrix>
  ColumnOperator product(const Matrix& matrix) {
    return [this, &matrix](const solver::ColumnsIn& x,
                           const solver::ColumnsOut& y) {
      products_.apply(matrix, x, y);
      space_.project(y);
    };
  }

  /// Of rigid pins apart: their motions, and the rest with them at rest.
  void precondition(const solver::Preconditioner& preconditioner,
                    const solver::ColumnsIn& r, const solver::ColumnsOut& z) {
    if (!space_.has_pins()) {
      products_.apply(preconditioner, r, z);
      return;
    }
    solver::Columns rest = r;
    space_.hold(rest);
    products_.apply(preconditioner, rest, z);
    space_.add_motions(r, z);
  }

  const equations::ElasticOperator& op_;
  const PinSpace& space_;
  solver::ColumnProducts products_;
};

}  // namespace

EigenPairs eigenpairs_of(const equations::ElasticOperator& op,
                         const solver::NodalMatrix& A,
                         const solver::Columns& start,
                         const EigenOptions& options, bool may_factor) {
  const solver::BlockPattern& pattern = op.table->pattern;
  const bool small = 3 * pattern.nodes <= solver::kSecondChance;
  EigenOptions first = options;
  if (may_factor && small) {
    first.max_iterations = std::min(options.max_iterations, kSlow);
  }
  const PinSpace space(op);
  ElasticProducts products(op, space);
  EigenPairs pairs =
      largest_eigenpairs(products.problem(A, *op.preconditioner), start, first);
  const bool slow = may_factor && pairs.end == EigenEnd::TooManyIterations;
  if (small && (slow || pairs.end == EigenEnd::NotPositive)) {
    const auto factor = solver::make_direct(pattern, op.K, op.freedom);
    pairs = largest_eigenpairs(products.problem(A, *factor),
                               slow ? pairs.x : start, options);
  }
  return pairs;
}

solver::Columns start_columns(const solver::NodeOrder& order,
                              const solver::Columns& own,
                              const std::vector<VectorX>* shapes) {
  if (shapes == nullptr || shapes->empty()) {
    return own;
  }
  const auto rows = static_cast<Eigen::Index>(3 * order.to_mesh.size());
  const Eigen::Index first = own.cols();
  solver::Columns start(rows,
                        first + static_cast<Eigen::Index>(shapes->size()));
  if (first > 0) {
    start.leftCols(first) = own;
  }
  for (std::size_t k = 0; k < shapes->size(); ++k) {
    const VectorX& shape = (*shapes)[k];
    if (shape.size() != rows) {
      throw InvalidInput(
          fmt::format("eigenvalues: a shape to begin with has {} numbers for "
                      "{} nodes",
                      shape.size(), order.to_mesh.size()));
    }
    start.col(first + static_cast<Eigen::Index>(k)) =
        equations::to_solver(order, shape);
  }
  return start;
}

std::optional<Failure> why_not(const EigenPairs& pairs,
                               const std::string& what) {
  switch (pairs.end) {
    case EigenEnd::Converged:
      return std::nullopt;
    case EigenEnd::TooManyIterations:
      return Failure{
          FailureKind::SolverFailed,
          fmt::format("{}: no convergence in {} iterations (residual {:.1e}): "
                      "many eigenvalues lie close together, or the design is "
                      "too far from the base design",
                      what, pairs.iterations, pairs.residuals.maxCoeff())};
    case EigenEnd::NotPositive:
      return Failure{
          FailureKind::SolverFailed,
          fmt::format("{}: the stiffness matrix is not positive definite: the "
                      "supports are too weak or an element is inverted",
                      what)};
    case EigenEnd::NotFinite:
      break;
  }
  return Failure{FailureKind::NotANumber,
                 fmt::format("{}: the numbers are not finite: check material, "
                             "stresses and node positions",
                             what)};
}

VectorX with_fixed_sign(VectorX x) {
  constexpr double kNearly = 1.0 - 1e-6;
  const double bound = x.size() == 0 ? 0.0 : kNearly * x.cwiseAbs().maxCoeff();
  const auto first = std::find_if(
      x.begin(), x.end(), [bound](double v) { return std::abs(v) >= bound; });
  if (first != x.end() && *first < 0.0) {
    x = -x;
  }
  return x;
}

double largest_of_nodes(const VectorX& x) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k + 2 < x.size(); k += 3) {
    largest = std::max(largest, x.segment<3>(k).norm());
  }
  return largest;
}

}  // namespace meniscus::modes
