#include "evolve/settle/nested_newton.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "core/math/dense.h"
#include "core/operation_count.h"
#include "evolve/energy/held_pressure.h"

namespace meniscus::settle {

namespace {

constexpr int kMostLinear = 200;
constexpr double kFirstReduction = 1e-3;  // of the linear residual
constexpr double kServes = 0.3;           // a step's reduction of the residual
constexpr double kMostReduction = 1e-7;   // that single precision gives
constexpr double kAim = 0.1;              // of the bound, for the last solve
constexpr double kTurn = 0.15;            // cosine of a facet's turn in a step
constexpr int kModeSteps = 30;
constexpr double kModeAccuracy = 1e-4;  // of the lowest eigenvalue, relative

double bounding_diagonal2(const Points& points) {
  const double d = bounding_diagonal(points);
  return std::max(1e-300, d * d);
}

}  // namespace

NestedNewton::NestedNewton(const std::vector<FilmLevel>& levels,
                           const films::FilmTargets& targets)
    : energy_(*levels.back().energy), targets_(targets), multigrid_(levels) {
  for (int b = 0; b < energy_.functionals(); ++b) {
    if (targets.bodies[b].volume) {
      held_.push_back(b);
    }
  }
}

void NestedNewton::evaluate(const Points& points) {
  points_ = points;
  directions_ = energy_.space().directions(points_);
  slope_ = energy_.gradient(points_, targets_);
  gradient_ = energy_.along(slope_, directions_);
  metric_ = energy_.lumped_area(points_);
  const int functionals = energy_.functionals();
  functional_.resize(energy_.unknowns(), functionals);
  functional_slope_.resize(functionals);
  for (int b = 0; b < functionals; ++b) {
    functional_slope_[b] = energy_.functional_gradient(points_, b);
    functional_.col(b) = energy_.along(functional_slope_[b], directions_);
  }
  values_ = functionals > 0 ? energy_.volumes(points_) : VectorX();
  const Eigen::MatrixXd rigid =
      energy_.rigid_motions(points_, directions_, metric_);
  const auto held = static_cast<Eigen::Index>(held_.size());
  constraints_.resize(energy_.unknowns(), held + rigid.cols());
  for (Eigen::Index k = 0; k < held; ++k) {
    constraints_.col(k) = functional_.col(held_[k]);
  }
  constraints_.rightCols(rigid.cols()) = rigid;
}

VectorX NestedNewton::residual() const {
  VectorX r = gradient_;
  if (functional_.cols() > 0) {
    r -= functional_ * pressure_;
  }
  return r;
}

double NestedNewton::residual_norm(const VectorX& r) const {
  const auto rigid =
      constraints_.cols() - static_cast<Eigen::Index>(held_.size());
  if (!r.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  if (rigid == 0) {
    return r.size() > 0 ? r.cwiseAbs().maxCoeff() : 0.0;
  }
  const auto t = constraints_.rightCols(rigid);
  const Eigen::MatrixXd gram = t.transpose() * t;
  const VectorX part = solve_ldlt(gram, t.transpose() * r);
  return (r - t * part).cwiseAbs().maxCoeff();
}

VectorX NestedNewton::missing() const {
  VectorX c = VectorX::Zero(constraints_.cols());
  for (std::size_t k = 0; k < held_.size(); ++k) {
    c[static_cast<Eigen::Index>(k)] =
        *targets_.bodies[held_[k]].volume - values_[held_[k]];
  }
  return c;
}

bool NestedNewton::volumes_hold(double tolerance) const {
  return std::all_of(held_.begin(), held_.end(), [&](int b) {
    const double target = *targets_.bodies[b].volume;
    return std::abs(values_[b] - target) <= tolerance * std::abs(target);
  });
}

bool NestedNewton::refresh() {
  energy::WallBends walls;
  if (energy_.space().has_walls()) {
    walls.gradient = slope_;
    for (int b = 0; b < energy_.functionals(); ++b) {
      for (std::size_t v = 0; v < slope_.size(); ++v) {
        walls.gradient[v] -= pressure_[b] * functional_slope_[b][v];
      }
    }
  }
  std::vector<double> elements;
  energy_.elements(points_, directions_, targets_, pressure_, walls, elements);
  // Held volumes and rigid motions leave modes that only the constraints
  // hold; the preconditioner gets them from the shift.
  const double tension = films::largest_tension(targets_);
  const double shift =
      constraints_.cols() > 0 ? tension / bounding_diagonal2(points_) : 0.0;
  if (!multigrid_.refresh(directions_, elements, metric_, shift)) {
    return false;
  }
  const Eigen::Index m = constraints_.cols();
  inverse_constraints_.resize(energy_.unknowns(), m);
  for (Eigen::Index k = 0; k < m; ++k) {
    inverse_constraints_.col(k) = multigrid_.precondition(constraints_.col(k));
  }
  if (m > 0) {
    const Eigen::MatrixXd schur =
        constraints_.transpose() * inverse_constraints_;
    // Not made symmetric: so the projection is exact in double precision,
    // whatever the preconditioner's rounding.
    schur_inverse_ = pseudo_inverse(schur);
  }
  return true;
}

/// The preconditioner on the space that keeps the constraints. What the
/// constraints take of `right` is removed from it and added to `multipliers`,
/// which keeps `right` small (Gould, Hribar, Nocedal 2001, section 6).
VectorX NestedNewton::project(VectorX& right, VectorX& multipliers) const {
  VectorX z = multigrid_.precondition(right);
  if (constraints_.cols() > 0) {
    count_operations(6.0 * static_cast<double>(constraints_.size()));
    const VectorX y = schur_inverse_ * (constraints_.transpose() * z);
    z -= inverse_constraints_ * y;
    right -= constraints_ * y;
    multipliers += y;
  }
  return z;
}

NestedNewton::Step NestedNewton::solve(const VectorX& residual,
                                       const VectorX& missing, double factor) {
  Step step;
  step.heights = VectorX::Zero(residual.size());
  VectorX g = residual;
  if (constraints_.cols() > 0) {
    step.heights = inverse_constraints_ * (schur_inverse_ * missing);
    g += multigrid_.multiply(step.heights);
  }
  VectorX multipliers = VectorX::Zero(constraints_.cols());
  VectorX z = project(g, multipliers);
  VectorX p = -z;
  double gz = g.dot(z);
  const double enough = factor * factor * gz;
  for (; step.iterations < kMostLinear && gz > enough; ++step.iterations) {
    count_operations(10.0 * static_cast<double>(p.size()));
    const VectorX kp = multigrid_.multiply(p);
    const double curvature = p.dot(kp);
    if (!(curvature > 0.0)) {
      step.positive = false;
      return step;
    }
    const double alpha = gz / curvature;
    step.heights += alpha * p;
    g += alpha * kp;
    z = project(g, multipliers);
    const double next = g.dot(z);
    p = (next / gz) * p - z;
    gz = next;
  }
  step.pressure = multipliers.head(static_cast<Eigen::Index>(held_.size()));
  return step;
}

NestedResult NestedNewton::run(const Points& start, const VectorX& pressure,
                               const NestedOptions& options) {
  NestedResult result;
  evaluate(start);
  if (pressure.size() == energy_.functionals()) {
    pressure_ = pressure;
  } else {
    pressure_ = energy::guess_pressures(targets_, held_, gradient_, functional_,
                                        metric_);
  }
  double before = std::numeric_limits<double>::infinity();
  double first = 0.0;
  int rises = 0;
  for (;; ++result.iterations) {
    if (options.monitor != nullptr) {
      throw_if_stopped(*options.monitor, "film");
    }
    const VectorX r = residual();
    const double norm = residual_norm(r);
    result.residual = norm;
    first = result.iterations == 0 ? norm : first;
    const bool early = options.reduction > 0.0 && result.iterations > 0 &&
                       norm <= options.reduction * first;
    if (early || (norm <= options.residual_bound &&
                  volumes_hold(options.volume_tolerance))) {
      result.converged = true;
      break;
    }
    rises = norm > 0.5 * before ? rises + 1 : 0;
    if (!std::isfinite(norm) || rises > 2 ||
        result.iterations >= options.max_iterations) {
      result.reason = "the residual does not fall";
      break;
    }
    // The film's normals turn with every step, so convergence may be linear
    // at the end: a Hessian that still serves is kept, and no step is solved
    // better than the last one's success promises (Eisenstat, Walker 1996).
    const double ratio = result.iterations == 0 ? 1.0 : norm / before;
    const bool serves = result.iterations > 1 && ratio < kServes;
    before = norm;
    if (!serves && !refresh()) {
      result.reason = "the Hessian cannot be preconditioned";
      break;
    }
    const double aim =
        std::max(kAim * options.residual_bound, options.reduction * first) /
        norm;
    const double factor =
        result.iterations == 0
            ? kFirstReduction
            : std::max({aim, kMostReduction, std::min(0.1, ratio * ratio)});
    const Step step = solve(r, missing(), factor);
    result.linear_iterations += step.iterations;
    if (!step.positive) {
      result.reason = "the energy curves down";
      break;
    }
    Points next;
    try {
      next = energy_.space().moved(points_, directions_, step.heights);
    } catch (const energy::OffWalls& error) {
      result.reason = error.what();
      break;
    }
    if (energy_.smallest_cosine(next, points_) < kTurn) {
      result.reason = "a step folds the film";
      break;
    }
    for (std::size_t k = 0; k < held_.size(); ++k) {
      pressure_[held_[k]] += step.pressure[static_cast<Eigen::Index>(k)];
    }
    evaluate(next);
  }
  result.points = points_;
  result.pressure = pressure_;
  return result;
}

NestedModes NestedNewton::lowest_modes(const Eigen::MatrixXd& coarse_guesses) {
  NestedModes result;
  const Eigen::Index k = coarse_guesses.cols();
  const auto n = static_cast<Eigen::Index>(energy_.unknowns());
  if (k == 0 || n == 0 || !refresh()) {
    return result;
  }
  // LOBPCG (Knyazev 2001) for A v = l M v on the kernel of B', preconditioned
  // by one projected multigrid cycle. Start: the coarse modes prolonged, minus
  // their part across the constraints.
  const auto keep = [&](VectorX v) {
    if (constraints_.cols() > 0) {
      const VectorX lack = constraints_.transpose() * v;
      v -= inverse_constraints_ * (schur_inverse_ * lack);
    }
    return v;
  };
  Eigen::MatrixXd x(n, k);
  for (Eigen::Index j = 0; j < k; ++j) {
    x.col(j) = keep(multigrid_.prolong(coarse_guesses.col(j)));
  }
  Eigen::MatrixXd kx(n, k);
  for (Eigen::Index j = 0; j < k; ++j) {
    kx.col(j) = multigrid_.multiply(x.col(j));
  }
  Eigen::MatrixXd p(n, 0);
  Eigen::MatrixXd kp(n, 0);
  VectorX values = VectorX::Constant(k, 1e300);
  for (int step = 0; step < kModeSteps; ++step) {
    // Projected preconditioned residuals W; with X and the last steps P they
    // span the trial space.
    Eigen::MatrixXd w(n, step == 0 ? 0 : k);
    Eigen::MatrixXd kw(n, w.cols());
    for (Eigen::Index j = 0; j < w.cols(); ++j) {
      VectorX r = kx.col(j) - values[j] * metric_.cwiseProduct(x.col(j));
      VectorX multipliers = VectorX::Zero(constraints_.cols());
      w.col(j) = project(r, multipliers);
      kw.col(j) = multigrid_.multiply(w.col(j));
    }
    Eigen::MatrixXd s(n, k + w.cols() + p.cols());
    Eigen::MatrixXd ks(n, s.cols());
    s << x, w, p;
    ks << kx, kw, kp;
    // An M-orthonormal basis of it from the eigenvectors of the scaled Gram
    // matrix, nearly dependent ones dropped (compare Hetmaniuk, Lehoucq 2006).
    const Eigen::MatrixXd mass = s.transpose() * metric_.asDiagonal() * s;
    const VectorX scale =
        mass.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd unit = scale.asDiagonal() * mass * scale.asDiagonal();
    const auto gram = symmetric_eigen(unit);
    Eigen::Index drop = 0;
    while (drop < s.cols() - k && gram.values[drop] < 1e-12) {
      ++drop;
    }
    const Eigen::Index m = s.cols() - drop;
    const Eigen::MatrixXd basis =
        scale.asDiagonal() * gram.vectors.rightCols(m) *
        gram.values.tail(m).cwiseSqrt().cwiseInverse().asDiagonal();
    // Rayleigh-Ritz: the k lowest pairs in the trial space.
    const Eigen::MatrixXd stiff = s.transpose() * ks;
    const Eigen::MatrixXd small =
        basis.transpose() * (0.5 * (stiff + stiff.transpose())) * basis;
    const auto ritz = symmetric_eigen(small);
    const Eigen::MatrixXd y = basis * ritz.vectors.leftCols(k);
    // The next P is the new X without what comes from the old X. A X and A P
    // follow by the same combinations, without products.
    Eigen::MatrixXd y_rest = y;
    y_rest.topRows(k).setZero();
    const Eigen::MatrixXd x_next = s * y;
    const Eigen::MatrixXd kx_next = ks * y;
    if (step > 0) {
      p = s * y_rest;
      kp = ks * y_rest;
    }
    x = x_next;
    kx = kx_next;
    const VectorX next = ritz.values.head(k);
    const double change = (next - values).cwiseAbs().maxCoeff();
    values = next;
    if (step > 1 && change <= kModeAccuracy * next.cwiseAbs().maxCoeff()) {
      break;
    }
  }
  result.eigenvalues = values;
  result.modes = x;
  Eigen::Index at = 0;
  x.col(0).cwiseAbs().maxCoeff(&at);
  result.position = points_[energy_.vertices()[at]];
  return result;
}

}  // namespace meniscus::settle
