#include "fea/shell_modes/shell_modes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel_for.h"
#include "core/timer.h"
#include "fea/modes/eigen_shapes.h"
#include "fea/modes/eigenpairs.h"
#include "fea/shell/shell_assembly.h"
#include "fea/shell/shell_factor.h"
#include "fea/shell/shell_held.h"
#include "fea/solver/multi_vector.h"

namespace meniscus::shell {

namespace {

/// Residuals are not asked to be below so many times what rounding leaves.
constexpr double kRounding = 10.0;

/// Where so many steps do not find the least factor, as where much is pulled
/// and little pressed, the search goes on from the shell under so much of it.
constexpr int kQuick = 30;
constexpr double kCarried = 0.5;

/// Of a symmetric matrix by its lower triangle, on loan.
modes::ColumnOperator product_with(const SparseMatrix& lower) {
  return [&lower](const solver::ColumnsIn& x, const solver::ColumnsOut& y) {
    solver::ColumnsOut out = y;
    parallel_for(x.cols(), [&](std::ptrdiff_t k) {
      out.col(k).noalias() = lower.selfadjointView<Eigen::Lower>() * x.col(k);
    });
  };
}

/// K^-1 times columns, by a factor on loan.
using Inverse = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& right)>;

template <class Factor>
Inverse inverse_by(const Factor& factor) {
  return
      [&factor](const Eigen::MatrixXd& right) { return factor.solve(right); };
}

/// A against K, both on loan, on all unknowns; `inverse` of K.
modes::EigenProblem shell_problem(const SparseMatrix& A, const SparseMatrix& K,
                                  const Inverse& inverse) {
  return {
      .rows = K.rows(),
      .dimension = K.rows(),
      .K = product_with(K),
      .A = product_with(A),
      .preconditioner =
          [inverse](const solver::ColumnsIn& r, const solver::ColumnsOut& z) {
            solver::ColumnsOut out = z;
            out = inverse(r);
          },
      .project = [](const solver::ColumnsOut&) {}};
}

/// What rounding leaves of a residual, in the norm of K^-1, of a vector as soft
/// as the lowest modes with x^T K x = 1: of slender shells more than the usual
/// tolerance.
double rounding_of(const SparseMatrix& K, const Inverse& inverse) {
  constexpr double kBit = std::numeric_limits<double>::epsilon();
  VectorX scattered(K.rows());
  for (Eigen::Index i = 0; i < scattered.size(); ++i) {
    scattered[i] = std::sin(static_cast<double>(i) + 1.0);
  }
  VectorX x = inverse(scattered);
  x /= std::sqrt(x.dot(scattered));
  const SparseMatrix size = K.cwiseAbs();
  const VectorX lost =
      kBit * (size.selfadjointView<Eigen::Lower>() * x.cwiseAbs())
                 .cwiseProduct(scattered);
  return std::sqrt(std::max(0.0, lost.dot(VectorX(inverse(lost)))));
}

double tolerance_of(double asked, const SparseMatrix& K,
                    const Inverse& inverse) {
  return std::max(asked, kRounding * rounding_of(K, inverse));
}

/// The pairs of A against K by those against K - s A, which are of theta / (1 -
/// s theta) and the same vectors: what is pulled lies between -1 / s and 0
/// there, far below the first. s, part of the first factor as `known` has it,
/// is halved until that matrix is definite: below all factors.
modes::EigenPairs pairs_under_loads(const SparseMatrix& A,
                                    const SparseMatrix& K,
                                    const modes::EigenPairs& known,
                                    modes::EigenOptions search) {
  double s = kCarried / std::max(known.theta[0], search.floor);
  SparseMatrix shifted = K - s * A;
  SymmetricFactor factor(shifted, FactorKind::Cholesky);
  while (!factor.factorize(shifted)) {
    s *= 0.5;
    shifted = K - s * A;
  }
  search.tolerance =
      tolerance_of(search.tolerance, shifted, inverse_by(factor));
  search.floor = search.floor / (1.0 - s * search.floor);
  modes::EigenPairs pairs = modes::largest_eigenpairs(
      shell_problem(A, shifted, inverse_by(factor)), known.x, search);
  for (Eigen::Index k = 0; k < pairs.theta.size(); ++k) {
    pairs.residuals[k] /= std::abs(1.0 + s * pairs.theta[k]);
    pairs.theta[k] /= 1.0 + s * pairs.theta[k];
  }
  pairs.iterations += known.iterations;
  return pairs;
}

/// `own` columns, and after them shapes of 6 numbers per node.
solver::Columns shapes_to_begin_with(const ShellFreedom& freedom,
                                     const Eigen::MatrixXd& own,
                                     const std::vector<VectorX>* shapes) {
  const std::size_t more = shapes != nullptr ? shapes->size() : 0;
  solver::Columns start(freedom.unknowns(),
                        own.cols() + static_cast<Eigen::Index>(more));
  if (own.cols() > 0) {
    start.leftCols(own.cols()) = own;
  }
  for (std::size_t k = 0; k < more; ++k) {
    start.col(own.cols() + static_cast<Eigen::Index>(k)) =
        freedom.unknowns_of((*shapes)[k]);
  }
  return start;
}

/// On what is held at some value, too, a mode rests.
VectorX nodal_shape(const ShellFreedom& freedom, const VectorX& unknowns) {
  return freedom.expand(unknowns) - freedom.held_values();
}

/// 1 or -1, by which displacements get their fixed sign.
double sign_of(const VectorX& six) {
  const VectorX three = displacements_of(six);
  return modes::with_fixed_sign(three).dot(three) < 0.0 ? -1.0 : 1.0;
}

void require_density(const std::vector<Section>& sections) {
  for (const Section& section : sections) {
    for (const Ply& ply : section.laminate.plies) {
      if (!(ply.material.density > 0.0)) {
        throw InvalidInput(fmt::format(
            "natural frequencies: material '{}' of a shell has density {}; "
            "give its mass per volume",
            ply.material.name, ply.material.density));
      }
    }
  }
}

/// About the square of a free plate's first frequency, so that all of its
/// lowest stand apart [1/time^2].
double bending_square(const ShellMesh& mesh,
                      const std::vector<Section>& sections) {
  Vec3 low = mesh.nodes.front();
  Vec3 high = low;
  for (const Vec3& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  double sum = 0.0;
  for (const Vec3& t : mesh.thickness) {
    sum += t.mean();
  }
  const double thickness = sum / static_cast<double>(mesh.thickness.size());
  double square = 0.0;
  for (const LaminateLaw& law : laminate_laws(sections)) {
    for (const PlyLaw& ply : law.plies) {
      square = std::max(square, ply.plane(0, 0) / ply.density);
    }
  }
  return 10.0 * square * std::pow(thickness / (high - low).squaredNorm(), 2);
}

struct ShellVibration {
  const SparseMatrix& M;
  const SparseMatrix& K;  // shifted by shift M
  Inverse inverse;
  const ShellFreedom& freedom;
  double shift = 0.0;
  Eigen::MatrixXd motions = {};  // that supports leave
};

modes::NaturalModes frequencies_of(const ShellVibration& shell,
                                   const modes::ModeOptions& options) {
  const auto rigid = static_cast<int>(shell.motions.cols());
  const modes::EigenPairs pairs = modes::largest_eigenpairs(
      shell_problem(shell.M, shell.K, shell.inverse),
      shapes_to_begin_with(shell.freedom, shell.motions, options.start),
      {.count = options.count + rigid,
       .tolerance = tolerance_of(options.tolerance, shell.K, shell.inverse),
       .max_iterations = options.max_iterations,
       .monitor = options.monitor});
  modes::NaturalModes found;
  found.failure = modes::why_not(pairs, "natural frequencies");
  found.iterations = pairs.iterations;
  found.rigid_motions = rigid;
  for (Eigen::Index k = rigid; k < pairs.theta.size(); ++k) {
    const double square = std::max(0.0, 1.0 / pairs.theta[k] - shell.shift);
    found.frequencies.push_back(std::sqrt(square) / (2.0 * std::numbers::pi));
    found.residuals.push_back(pairs.residuals[k]);
    const VectorX x =
        nodal_shape(shell.freedom, pairs.x.col(k) / std::sqrt(pairs.theta[k]));
    found.shapes.push_back(sign_of(x) * x);
  }
  return found;
}

}  // namespace

modes::NaturalModes natural_modes(const ShellSystem& system,
                                  const std::vector<Section>& sections,
                                  const modes::ModeOptions& options) {
  const Timer timer;
  require_density(sections);
  const SparseMatrix K = system.stiffness();
  const SparseMatrix M = system.mass();
  modes::NaturalModes found = frequencies_of(
      {M, K, inverse_by(system.factor()), system.freedom()}, options);
  found.seconds = timer.seconds();
  return found;
}

modes::NaturalModes natural_modes(const ShellMesh& mesh,
                                  const std::vector<Section>& sections,
                                  const std::vector<NodeSupport>& supports,
                                  const modes::ModeOptions& options) {
  const Timer timer;
  check_shell(mesh, sections);
  require_density(sections);
  const std::vector<LaminateLaw> laws = laminate_laws(sections);
  const ShellFreedom freedom(static_cast<int>(mesh.nodes.size()), supports);
  const ShellAssembly assembly(mesh, freedom);
  const Eigen::MatrixXd motions = free_motions(mesh, freedom);
  const double shift =
      motions.cols() > 0 ? bending_square(mesh, sections) : 0.0;
  const SparseMatrix M = assembly.sum(
      [&](int f) { return facet_mass(facet_of(mesh, sections, laws, f)); });
  const auto stiff = [&](int f) -> FacetMatrix {
    const Facet facet = facet_of(mesh, sections, laws, f);
    return condensed(whole_stiffness(facet)) + shift * facet_mass(facet);
  };
  const SparseMatrix K = assembly.sum(stiff);
  const ShellFactor factor(mesh, freedom, stiff);
  modes::NaturalModes found = frequencies_of(
      {M, K, inverse_by(factor), freedom, shift, motions}, options);
  found.seconds = timer.seconds();
  return found;
}

modes::BucklingModes buckling_modes(const ShellSystem& system,
                                    const ShellLoads& loads,
                                    const VectorX& displacement,
                                    const std::string& load_case,
                                    const modes::BucklingOptions& options) {
  const Timer timer;
  const double sign = options.sense == modes::LoadSense::AsGiven ? -1.0 : 1.0;
  const SparseMatrix A = sign * system.geometric(loads, displacement);
  const SparseMatrix K = system.stiffness();
  const Inverse inverse = inverse_by(system.factor());
  const solver::Columns start =
      shapes_to_begin_with(system.freedom(), {}, options.start);
  modes::EigenOptions search{
      .count = options.count,
      .tolerance = tolerance_of(options.tolerance, K, inverse),
      .floor = 1.0 / options.largest,
      .guards = options.guards,
      .max_iterations = std::min(options.max_iterations, kQuick),
      .monitor = options.monitor};
  modes::EigenPairs pairs =
      modes::largest_eigenpairs(shell_problem(A, K, inverse), start, search);
  if (pairs.end == modes::EigenEnd::TooManyIterations &&
      options.max_iterations > kQuick) {
    search.tolerance = options.tolerance;
    search.max_iterations = options.max_iterations;
    pairs = pairs_under_loads(A, K, pairs, search);
  }
  modes::BucklingModes found = modes::factors_of(pairs, options, load_case);
  for (std::size_t k = 0; k < found.factors.size(); ++k) {
    const VectorX x = nodal_shape(system.freedom(),
                                  pairs.x.col(static_cast<Eigen::Index>(k)));
    found.shapes.push_back(sign_of(x) * x /
                           modes::largest_of_nodes(displacements_of(x)));
  }
  found.seconds = timer.seconds();
  return found;
}

}  // namespace meniscus::shell
