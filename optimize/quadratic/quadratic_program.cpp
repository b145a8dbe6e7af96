#include "optimize/quadratic/quadratic_program.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "core/math/dense.h"
#include "optimize/quadratic/nonnegative_least_squares.h"

namespace meniscus::quadratic {
namespace {

// |f - E u|^2 below this: no point keeps the inequalities (about 1 / |y|^2 of
// the nearest one, in units of the farthest single row).
constexpr double kNothing = 1e-13;
// Eigenvalues of the hessian below this x the largest count as this.
constexpr double kFlat = 1e-11;
// What a row may be missed by, x its length and the step's.
constexpr double kMissed = 1e-7;
// A step this near to the box ends at it.
constexpr double kAtBox = 1e-7;
// Weight of the step where misses are to be least.
constexpr double kLightStep = 1e-8;

// All inequalities as G d >= h, rows of length 1 in the coordinates y.
struct Inequalities {
  Eigen::MatrixXd G;
  VectorX h;
  VectorX length;
};

struct Bounded {
  Eigen::Index variable = 0;
  double sign = 1.0;
  double limit = 0.0;  // sign d <= limit
};

std::vector<Bounded> bounds_of(const QuadraticProgram& program) {
  std::vector<Bounded> bounds;
  for (Eigen::Index j = 0; j < program.slope.size(); ++j) {
    if (std::isfinite(program.high[j])) {
      bounds.push_back({j, 1.0, program.high[j]});
    }
    if (std::isfinite(program.low[j])) {
      bounds.push_back({j, -1.0, -program.low[j]});
    }
  }
  return bounds;
}

// W with W' hessian W = 1; flat directions are taken as nearly flat. Empty for
// a hessian that is not positive.
Eigen::MatrixXd unit_coordinates(const Eigen::MatrixXd& hessian) {
  const SymmetricEigen<Eigen::Dynamic> eigen = symmetric_eigen(hessian);
  const double largest = eigen.values.tail(1)[0];
  if (!(largest > 0.0) || !eigen.vectors.allFinite()) {
    return {};
  }
  const VectorX values = eigen.values.cwiseMax(kFlat * largest);
  return eigen.vectors * values.cwiseSqrt().cwiseInverse().asDiagonal();
}

// `free`: the minimiser without inequalities. With d = free + W y the
// quadratic is |y|^2 / 2.
Inequalities in_coordinates(const QuadraticProgram& program,
                            const Eigen::MatrixXd& W, const VectorX& free) {
  const std::vector<Bounded> bounds = bounds_of(program);
  const Eigen::Index m = program.limits.size();
  const Eigen::Index all = m + static_cast<Eigen::Index>(bounds.size());
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(all, free.size());
  VectorX limits(all);
  given.topRows(m) = program.rows;
  limits.head(m) = program.limits;
  for (Eigen::Index k = m; k < all; ++k) {
    const Bounded& bound = bounds[static_cast<std::size_t>(k - m)];
    given(k, bound.variable) = bound.sign;
    limits[k] = bound.limit;
  }
  Inequalities result;
  result.h = given * free - limits;
  result.G = -given * W;
  result.length = result.G.rowwise().norm();
  for (Eigen::Index k = 0; k < all; ++k) {
    if (result.length[k] > 0.0) {
      result.G.row(k) /= result.length[k];
      result.h[k] /= result.length[k];
    }
  }
  return result;
}

// The largest step that the box allows, or 1 without a box, as a power of two:
// division by it keeps every bit.
double box_size(const QuadraticProgram& program) {
  double size = 0.0;
  for (const Bounded& bound : bounds_of(program)) {
    size = std::max(size, std::abs(bound.limit));
  }
  return size > 0.0 ? std::exp2(std::round(std::log2(size))) : 1.0;
}

// The same in steps of `unit`.
QuadraticProgram in_steps_of(double unit, QuadraticProgram program) {
  program.hessian *= unit * unit;
  program.slope *= unit;
  program.low /= unit;
  program.high /= unit;
  program.rows *= unit;
  return program;
}

bool keeps_rows(const QuadraticProgram& program, const VectorX& step) {
  const VectorX missed = program.rows * step - program.limits;
  for (Eigen::Index k = 0; k < missed.size(); ++k) {
    const double length =
        program.rows.row(k).norm() * step.norm() + std::abs(program.limits[k]);
    if (missed[k] > kMissed * length) {
      return false;
    }
  }
  return true;
}

}  // namespace

void QuadraticProgram::add(const VectorX& row, double limit) {
  const Eigen::Index m = limits.size();
  rows.conservativeResize(m + 1, row.size());
  limits.conservativeResize(m + 1);
  rows.row(m) = row.transpose();
  limits[m] = limit;
}

namespace {

// `unit_of_variables`: in those that the program was given in.
std::optional<QuadraticAnswer> solve_of_unit_size(
    const QuadraticProgram& program, double unit_of_variables) {
  const Eigen::MatrixXd W = unit_coordinates(program.hessian);
  if (W.size() == 0) {
    return std::nullopt;
  }
  const VectorX free = -(W * (W.transpose() * program.slope));
  const Inequalities all = in_coordinates(program, W, free);
  const Eigen::Index n = free.size();
  const Eigen::Index m = program.limits.size();
  QuadraticAnswer answer{.step = free, .multipliers = VectorX::Zero(m)};
  // The farthest row is the unit of length.
  const double unit = all.h.size() == 0 ? 0.0 : all.h.maxCoeff();
  if (unit > 0.0) {
    // min |y| over G y >= h from min |[G h]' u - e| over u >= 0.
    Eigen::MatrixXd E(n + 1, all.h.size());
    E.topRows(n) = all.G.transpose();
    E.row(n) = all.h.transpose() / unit;
    const VectorX length = E.colwise().norm().cwiseMax(1e-300);
    E = E * length.cwiseInverse().asDiagonal();
    const VectorX target = VectorX::Unit(n + 1, n);
    const VectorX u = nonnegative_least_squares(E, target);
    const VectorX rest = target - E * u;
    if (!(rest[n] > kNothing)) {
      return std::nullopt;
    }
    const VectorX y = -unit / rest[n] * rest.head(n);
    answer.step = free + W * y;
    answer.multipliers =
        (unit / rest[n]) * u.head(m).cwiseQuotient(length.head(m).cwiseProduct(
                               all.length.head(m).cwiseMax(1e-300)));
  }
  answer.step = answer.step.cwiseMax(program.low).cwiseMin(program.high);
  if (!answer.step.allFinite() || !keeps_rows(program, answer.step)) {
    return std::nullopt;
  }
  // Rounding off a bound is no distance from it.
  VectorX at_bounds = answer.step;
  for (Eigen::Index j = 0; j < n; ++j) {
    double& d = at_bounds[j];
    const double near = std::min(kAtBox / unit_of_variables,
                                 0.25 * (program.high[j] - program.low[j]));
    d = d <= program.low[j] + near    ? program.low[j]
        : d >= program.high[j] - near ? program.high[j]
                                      : d;
  }
  if (keeps_rows(program, at_bounds)) {
    answer.step = at_bounds;
  }
  return answer;
}

}  // namespace

std::optional<QuadraticAnswer> solve_quadratic(
    const QuadraticProgram& program) {
  const double size = box_size(program);
  std::optional<QuadraticAnswer> answer =
      solve_of_unit_size(in_steps_of(size, program), size);
  if (answer) {
    answer->step *= size;
  }
  return answer;
}

VectorX least_misses(const QuadraticProgram& given) {
  // 1. In steps of the box, with the farthest that it lets a row go as the unit
  // of the rows.
  const double size = box_size(given);
  QuadraticProgram program = in_steps_of(size, given);
  double reach = 0.0;
  for (Eigen::Index k = 0; k < program.limits.size(); ++k) {
    reach = std::max(reach, program.rows.row(k).lpNorm<1>());
  }
  if (!(reach > 0.0)) {
    return (-given.limits).cwiseMax(0.0);
  }
  program.rows /= reach;
  program.limits /= reach;
  const Eigen::Index n = program.slope.size();
  const Eigen::Index m = program.limits.size();
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  // 2. Over (d, t): rows d - t <= limits, least |t|^2 and, lightly, |d|^2.
  QuadraticProgram loose;
  loose.hessian = Eigen::MatrixXd::Identity(n + m, n + m);
  loose.hessian.topLeftCorner(n, n) *= kLightStep;
  loose.slope = VectorX::Zero(n + m);
  loose.low = VectorX::Constant(n + m, -kUnbounded);
  loose.high = VectorX::Constant(n + m, kUnbounded);
  loose.low.head(n) = program.low;
  loose.high.head(n) = program.high;
  loose.rows = Eigen::MatrixXd::Zero(m, n + m);
  loose.rows.leftCols(n) = program.rows;
  loose.rows.rightCols(m) = -Eigen::MatrixXd::Identity(m, m);
  loose.limits = program.limits;
  const std::optional<QuadraticAnswer> found = solve_of_unit_size(loose, size);
  const VectorX step =
      found ? VectorX(size * found->step.head(n)) : VectorX::Zero(n);
  return (given.rows * step - given.limits).cwiseMax(0.0);
}

}  // namespace meniscus::quadratic
