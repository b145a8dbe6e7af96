#include "evolve/settle/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/math/dense.h"
#include "evolve/energy/held_pressure.h"

namespace meniscus::settle {

namespace {

constexpr double kFold = 0.15;          // cosine facet normal to directions
constexpr double kSumRounding = 1e-13;  // of sums over all facets, relative
constexpr double kShortest = 1.0 / 128.0;
constexpr int kMostShifts = 12;
constexpr int kMostShortSteps = 6;  // in a row, before giving up

}  // namespace

FilmNewton::FilmNewton(const energy::FilmEnergy& energy,
                       const films::FilmTargets& targets,
                       const NewtonOptions& options)
    : energy_(energy),
      targets_(targets),
      options_(options),
      system_(energy.pattern(), energy.order()),
      hessian_(energy.pattern()) {
  for (int b = 0; b < energy.functionals(); ++b) {
    if (targets.bodies[b].volume) {
      held_.push_back(b);
    }
  }
}

std::optional<FilmNewton::Trial> FilmNewton::trial_at(const VectorX& heights) {
  Trial trial;
  trial.heights = heights;
  try {
    trial.points = energy_.space().moved(base_, directions_, heights);
  } catch (const energy::OffWalls& error) {
    refusal_ = error.what();
    return std::nullopt;
  }
  trial.energy = energy_.value(trial.points, targets_);
  trial.volume = energy_.volumes(trial.points);
  return trial;
}

/// Derivatives at the current film.
void FilmNewton::evaluate() {
  const int n = energy_.unknowns();
  const int bodies = energy_.functionals();
  if (options_.rule == DirectionRule::CurrentNormals) {
    base_ = now_.points;
    now_.heights.setZero();
    directions_ = energy_.space().directions(base_);
  }
  paths_ = energy_.space().paths(base_, directions_, now_.heights);
  gradient_ =
      energy_.along(energy_.gradient(now_.points, targets_), paths_.first);
  volumes_dh_.resize(n, bodies);
  for (int b = 0; b < bodies; ++b) {
    volumes_dh_.col(b) = energy_.along(
        energy_.functional_gradient(now_.points, b), paths_.first);
  }
  metric_ = energy_.lumped_area(now_.points);
  const auto held = static_cast<int>(held_.size());
  const Eigen::MatrixXd rigid =
      energy_.rigid_motions(now_.points, paths_.first, metric_);
  constraints_.resize(n, held + rigid.cols());
  for (int k = 0; k < held; ++k) {
    constraints_.col(k) = volumes_dh_.col(held_[k]);
  }
  constraints_.rightCols(rigid.cols()) = rigid;
}

VectorX FilmNewton::residual_of(const VectorX& pressure) const {
  return gradient_ - volumes_dh_ * pressure;
}

/// Max norm, rigid translations of floating films left out.
double FilmNewton::residual_norm() const {
  VectorX r = residual_of(pressure_);
  const auto rigid =
      constraints_.cols() - static_cast<Eigen::Index>(held_.size());
  if (rigid > 0) {
    const Eigen::MatrixXd t = constraints_.rightCols(rigid);
    const VectorX part = solve_ldlt(t.transpose() * t, t.transpose() * r);
    r -= t * part;
  }
  const double norm = r.size() > 0 ? r.cwiseAbs().maxCoeff() : 0.0;
  return r.allFinite() ? norm : std::numeric_limits<double>::infinity();
}

VectorX FilmNewton::missing(const VectorX& volume) const {
  VectorX c = VectorX::Zero(constraints_.cols());
  for (std::size_t k = 0; k < held_.size(); ++k) {
    c[static_cast<Eigen::Index>(k)] =
        *targets_.bodies[held_[k]].volume - volume[held_[k]];
  }
  return c;
}

bool FilmNewton::volumes_hold() const {
  return std::all_of(held_.begin(), held_.end(), [&](int b) {
    const double target = *targets_.bodies[b].volume;
    return std::abs(now_.volume[b] - target) <=
           options_.volume_tolerance * std::abs(target);
  });
}

double FilmNewton::rounding() const {
  return kSumRounding *
         (std::abs(now_.energy) +
          pressure_.cwiseAbs().dot(now_.volume.cwiseAbs().matrix()));
}

/// Augmented Lagrangian; pressure bodies enter with their pressure.
double FilmNewton::merit(const Trial& trial, const VectorX& pressure,
                         double penalty) const {
  double sum = trial.energy;
  for (int b = 0; b < energy_.functionals(); ++b) {
    const double target = targets_.bodies[b].volume.value_or(0.0);
    sum -= pressure[b] * (trial.volume[b] - target);
  }
  return sum + 0.5 * penalty * missing(trial.volume).squaredNorm();
}

void FilmNewton::compute_hessian() {
  energy_.hessian(now_.points, paths_.first, targets_, pressure_, hessian_,
                  paths_.second.empty() ? nullptr : &paths_.second);
}

/// Factors the Hessian, shifted until it is positive on the constraint space
/// when a minimum is sought.
bool FilmNewton::factorize() {
  compute_hessian();
  double shift = options_.aim == NewtonAim::Minimum ? shift_ : 0.0;
  for (int attempt = 0; attempt < kMostShifts; ++attempt) {
    if (!system_.factorize(hessian_, metric_, shift, constraints_)) {
      return false;
    }
    if (options_.aim == NewtonAim::Equilibrium || system_.index() == 0) {
      shift_ = shift;
      return true;
    }
    shift = shift > 0.0 ? 4.0 * shift : base_shift_;
  }
  return false;
}

void FilmNewton::accept(Trial&& trial) {
  now_ = std::move(trial);
  refusal_.clear();
  evaluate();
}

bool FilmNewton::search_down(const energy::ConstrainedHessian::Step& step,
                             const VectorX& residual) {
  VectorX pressure = pressure_;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    pressure[held_[k]] += step.dp[static_cast<Eigen::Index>(k)];
  }
  const VectorX c = missing(now_.volume);
  // phi' = (r - B dp) . dh - penalty c.c, made negative by the penalty.
  const auto held = static_cast<Eigen::Index>(held_.size());
  const double plain =
      (residual - constraints_.leftCols(held) * step.dp.head(held))
          .dot(step.dh);
  const double gap = c.squaredNorm();
  const double penalty = system_.stiffness(held) +
                         (plain > 0.0 && gap > 0.0 ? 2.0 * plain / gap : 0.0);
  const double slope = plain - penalty * gap;
  const double start = merit(now_, pressure, penalty);
  const double fold =
      std::min(kFold, 0.9 * energy_.smallest_cosine(now_.points, base_));
  for (double s = 1.0; s >= kShortest; s *= 0.5) {
    std::optional<Trial> trial = trial_at(now_.heights + s * step.dh);
    if (trial && held > 0) {
      // Volumes curve away from the step; without bringing them back the
      // merit would refuse long steps (Maratos).
      const VectorX stray = missing(trial->volume) - (1.0 - s) * c;
      trial = trial_at(trial->heights + system_.restore(stray));
    }
    if (!trial || energy_.smallest_cosine(trial->points, base_) < fold) {
      continue;
    }
    if (merit(*trial, pressure, penalty) <=
        start + 1e-4 * s * slope + rounding()) {
      pressure_ += s * (pressure - pressure_);
      last_step_ = s;
      accept(std::move(*trial));
      return true;
    }
  }
  return false;
}

bool FilmNewton::search_residual(const energy::ConstrainedHessian::Step& step) {
  const double before = residual_norm();
  const double gap = missing(now_.volume).norm();
  const VectorX pressure = pressure_;
  const Trial old = now_;
  const Points old_base = base_;
  const Points old_directions = directions_;
  for (double s = 1.0; s >= 0.1; s *= 0.5) {
    std::optional<Trial> trial = trial_at(now_.heights + s * step.dh);
    if (!trial) {
      continue;
    }
    const double cosine = energy_.smallest_cosine(trial->points, base_);
    const double left = missing(trial->volume).norm();
    accept(std::move(*trial));
    for (std::size_t k = 0; k < held_.size(); ++k) {
      pressure_[held_[k]] += s * step.dp[static_cast<Eigen::Index>(k)];
    }
    const bool fell =
        residual_norm() < (1.0 - 0.1 * s) * before || left < 0.5 * gap;
    if ((fell || before <= options_.residual_bound) && cosine > kFold) {
      last_step_ = s;
      return true;
    }
    now_ = old;
    base_ = old_base;
    directions_ = old_directions;
    pressure_ = pressure;
    evaluate();
  }
  return false;
}

bool FilmNewton::advance() {
  for (int attempt = 0; attempt < 4; ++attempt) {
    if (!factorize()) {
      return false;
    }
    const VectorX residual = residual_of(pressure_);
    const auto step = system_.solve(residual, missing(now_.volume));
    if (!step.dh.allFinite()) {
      return false;
    }
    if (options_.aim == NewtonAim::Equilibrium) {
      return search_residual(step);
    }
    if (search_down(step, residual)) {
      if (last_step_ == 1.0) {
        shift_ = shift_ > 4.0 * base_shift_ ? 0.25 * shift_ : 0.0;
      } else if (last_step_ < 0.25) {
        shift_ = std::max(base_shift_, 4.0 * shift_);
      }
      return true;
    }
    shift_ = std::max(base_shift_, 16.0 * shift_);
  }
  return false;
}

/// One full step after the stop criterion, and the stability of the film.
void FilmNewton::polish(NewtonResult& result) {
  shift_ = 0.0;
  compute_hessian();
  if (!system_.factorize(hessian_, metric_, 0.0, constraints_)) {
    result.converged = false;
    result.reason = "the Hessian is singular";
    return;
  }
  const auto step = system_.solve(residual_of(pressure_), missing(now_.volume));
  result.index = system_.index();
  const energy::LowestMode lowest = system_.lowest_mode(metric_);
  result.min_eigenvalue = lowest.eigenvalue;
  Eigen::Index at = 0;
  if (lowest.mode.size() > 0) {
    lowest.mode.cwiseAbs().maxCoeff(&at);
    result.mode_position =
        now_.points[energy_.vertices()[static_cast<std::size_t>(at)]];
  }
  if (!step.dh.allFinite()) {
    return;
  }
  if (std::optional<Trial> trial = trial_at(now_.heights + step.dh)) {
    for (std::size_t k = 0; k < held_.size(); ++k) {
      pressure_[held_[k]] += step.dp[static_cast<Eigen::Index>(k)];
    }
    accept(std::move(*trial));
  }
}

NewtonResult FilmNewton::run(const Points& base, const Points& directions,
                             const VectorX& start) {
  base_ = base;
  directions_ = directions;
  // The first shift is tension / size^2, the scale of the Hessian's eigenvalues
  // in the metric of lumped area.
  const double diagonal = std::max(1e-300, bounding_diagonal(base));
  const double most_tension = films::largest_tension(targets_);
  base_shift_ = most_tension / (diagonal * diagonal);
  shift_ = 0.0;
  // Start heights, and pressures that fit the slopes best in the metric.
  NewtonResult result;
  const VectorX first =
      start.size() > 0 ? start : VectorX::Zero(energy_.unknowns());
  std::optional<Trial> trial = trial_at(first);
  if (!trial) {
    result.reason = refusal_;
    result.points = base;
    result.heights = first;
    result.pressure = VectorX::Zero(energy_.functionals());
    result.residual = std::numeric_limits<double>::infinity();
    return result;
  }
  accept(std::move(*trial));
  pressure_ =
      energy::guess_pressures(targets_, held_, gradient_, volumes_dh_, metric_);
  int short_steps = 0;
  for (;; ++result.iterations) {
    if (options_.monitor != nullptr) {
      throw_if_stopped(*options_.monitor, "film");
    }
    // Rest: residual and volumes within bounds. One more full step, and the
    // index and lowest eigenvalue at the film.
    if (residual_norm() <= options_.residual_bound && volumes_hold()) {
      result.converged = true;
      polish(result);
      break;
    }
    if (result.iterations >= options_.max_iterations) {
      result.reason = "the steps allowed are used up";
      break;
    }
    // A damped Newton step: a shifted Hessian and a search on the augmented
    // Lagrangian for a minimum, on the residual for a saddle.
    if (!advance()) {
      result.reason = refusal_.empty()
                          ? "no step lowers the energy without folding the film"
                          : refusal_;
      break;
    }
    // Steps that stay short are a film on its way to tear.
    short_steps = last_step_ < 0.1 ? short_steps + 1 : 0;
    if (short_steps >= kMostShortSteps) {
      result.reason = "the steps became too short";
      break;
    }
  }
  result.points = now_.points;
  result.heights = now_.heights;
  result.pressure = pressure_;
  result.residual = residual_norm();
  return result;
}

}  // namespace meniscus::settle
