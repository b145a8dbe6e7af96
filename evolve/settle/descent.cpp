#include "evolve/settle/descent.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/heed_stop.h"
#include "core/math/dense.h"

namespace meniscus::settle {

namespace {

constexpr int kMostDoublings = 30;
constexpr int kRestoreSteps = 20;
constexpr double kEnergyRounding = 1e-15;  // of the energy, relative

class Descent {
 public:
  Descent(const energy::FilmEnergy& energy, const films::FilmTargets& targets,
          const Points& directions, const Points& base,
          const DescentOptions& options)
      : energy_(energy),
        targets_(targets),
        directions_(directions),
        base_(base),
        options_(options) {
    for (int b = 0; b < energy.functionals(); ++b) {
      if (targets.bodies[b].volume) {
        held_.push_back(b);
      }
    }
    h_ = VectorX::Zero(energy.unknowns());
    metric_ = options.metric == DescentMetric::LumpedArea
                  ? VectorX(energy.lumped_area(base).cwiseMax(1e-300))
                  : VectorX(VectorX::Ones(energy.unknowns()));
    for (const int b : held_) {
      volume_.push_back(*targets.bodies[b].volume);
    }
    if (options.most_restore) {
      approach(*options.most_restore);
    } else {
      restore(h_);
    }
    now_ = value(h_);
  }

  double now() const { return now_; }
  double residual() const { return residual_; }
  double scale() const { return scale_; }
  const VectorX& pressure() const { return pressure_; }
  Points points() const { return at(h_); }
  long evaluations() const { return evaluations_; }

  /// Force per lumped area along the directions, without what the volumes
  /// take; and the residual.
  void find_force() {
    const Points x = at(h_);
    VectorX r = along(energy_.gradient(x, targets_));
    pressure_ = VectorX::Zero(energy_.functionals());
    for (int b = 0; b < energy_.functionals(); ++b) {
      pressure_[b] = targets_.bodies[b].pressure.value_or(0.0);
      if (pressure_[b] != 0.0) {
        r -= pressure_[b] * along(energy_.functional_gradient(x, b));
      }
    }
    const Eigen::MatrixXd b = volume_slopes(x);
    const VectorX weight = metric_.cwiseInverse();
    if (b.size() > 0) {
      const VectorX y = solve_ldlt(b.transpose() * weight.asDiagonal() * b,
                                   b.transpose() * weight.cwiseProduct(r));
      r -= b * y;
      for (std::size_t k = 0; k < held_.size(); ++k) {
        pressure_[held_[k]] = y[static_cast<Eigen::Index>(k)];
      }
    }
    residual_ = r.size() > 0 ? r.cwiseAbs().maxCoeff() : 0.0;
    const VectorX last = force_;
    force_ = -weight.cwiseProduct(r);
    const double product = force_.dot(metric_.cwiseProduct(force_));
    if (options_.method == DescentMethod::ConjugateGradients &&
        last.size() == force_.size() && product_ > 0.0) {
      const double mixed =
          force_.dot(metric_.cwiseProduct(force_ - last)) / product_;
      way_ = force_ + std::max(0.0, mixed) * way_;
      if (!(way_.dot(metric_.cwiseProduct(force_)) > 0.0)) {
        way_ = force_;
      }
    } else {
      way_ = force_;
    }
    product_ = product;
  }

  /// One step of the best scale. False where none lowers the energy.
  bool step() {
    if (way_.size() == 0) {
      return false;  // nothing moves
    }
    if (scale_ == 0.0) {
      const double fastest = way_.cwiseAbs().maxCoeff();
      const double edge = energy_.mean_edge(base_);
      scale_ = fastest > 0.0 ? 0.1 * edge / fastest : 1.0;
    }
    double s = scale_;
    double e = value_at(s);
    double before_s = 0.0;
    double before_e = now_;
    if (e < now_) {
      for (int k = 0; k < kMostDoublings; ++k) {
        const double next = value_at(2.0 * s);
        if (!(next < e)) {
          return take_best(before_s, before_e, s, e, 2.0 * s, next);
        }
        before_s = s;
        before_e = e;
        s *= 2.0;
        e = next;
      }
      return take(s);
    }
    for (int k = 0; k < kMostDoublings; ++k) {
      const double shorter = value_at(0.5 * s);
      if (shorter < now_) {
        return take_best(0.0, now_, 0.5 * s, shorter, s, e);
      }
      s *= 0.5;
      e = shorter;
    }
    return false;
  }

  /// Forgets the conjugate direction.
  void restart() { product_ = 0.0; }

 private:
  Points at(const VectorX& h) const {
    return energy_.space().moved(base_, directions_, h);
  }
  VectorX along(const Points& slope) const {
    return energy_.along(slope, directions_);
  }
  Eigen::MatrixXd volume_slopes(const Points& x) const {
    Eigen::MatrixXd b(energy_.unknowns(),
                      static_cast<Eigen::Index>(held_.size()));
    for (std::size_t k = 0; k < held_.size(); ++k) {
      b.col(static_cast<Eigen::Index>(k)) =
          along(energy_.functional_gradient(x, held_[k]));
    }
    return b;
  }
  double value(const VectorX& h) const {
    ++evaluations_;
    heed_stop("film");
    const Points x = at(h);
    double sum = energy_.value(x, targets_);
    const VectorX volumes = energy_.volumes(x);
    for (int b = 0; b < energy_.functionals(); ++b) {
      sum -= targets_.bodies[b].pressure.value_or(0.0) * volumes[b];
    }
    return sum;
  }
  VectorX missing(const Points& x) const {
    const VectorX volumes = energy_.volumes(x);
    VectorX gap(static_cast<Eigen::Index>(held_.size()));
    for (std::size_t k = 0; k < held_.size(); ++k) {
      gap[static_cast<Eigen::Index>(k)] = volume_[k] - volumes[held_[k]];
    }
    return gap;
  }
  VectorX heights_for(const Points& x, const VectorX& gap) const {
    const Eigen::MatrixXd b = volume_slopes(x);
    const Eigen::MatrixXd wb = metric_.cwiseInverse().asDiagonal() * b;
    return wb * solve_ldlt(b.transpose() * wb, gap);
  }
  /// One step towards the volumes, which are then held where they are.
  void approach(double most) {
    if (held_.empty()) {
      return;
    }
    const Points x = at(h_);
    const VectorX way = heights_for(x, missing(x));
    const double far = way.size() > 0 ? way.cwiseAbs().maxCoeff() : 0.0;
    if (far > 0.0 && std::isfinite(far)) {
      h_ += std::min(1.0, most / far) * way;
    }
    const VectorX volumes = energy_.volumes(at(h_));
    for (std::size_t k = 0; k < held_.size(); ++k) {
      volume_[k] = volumes[held_[k]];
    }
  }
  /// Newton steps along the volume slopes; false where they do not arrive.
  bool restore(VectorX& h) const {
    for (int k = 0; k < kRestoreSteps && !held_.empty(); ++k) {
      ++evaluations_;
      const Points x = at(h);
      const VectorX gap = missing(x);
      bool there = true;
      for (std::size_t i = 0; i < held_.size(); ++i) {
        there =
            there && std::abs(gap[static_cast<Eigen::Index>(i)]) <=
                         0.1 * options_.volume_tolerance * std::abs(volume_[i]);
      }
      if (there) {
        return true;
      }
      h += heights_for(x, gap);
      if (!h.allFinite()) {
        return false;
      }
    }
    return held_.empty();
  }
  VectorX trial(double s) const {
    VectorX h = h_ + s * way_;
    return restore(h) ? h : VectorX();
  }
  double value_at(double s) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    try {
      const VectorX h = trial(s);
      const double e = h.size() == h_.size() ? value(h) : kNone;
      return std::isfinite(e) ? e : kNone;
    } catch (const ExpressionError&) {
      return kNone;  // too far: a formula has no value there
    } catch (const MeshError&) {
      return kNone;  // or a wall cannot be reached
    }
  }
  bool take_best(double s0, double e0, double s1, double e1, double s2,
                 double e2) {
    // Minimum of the parabola through three points that bracket it.
    double best = s1;
    const double left = (s1 - s0) * (e1 - e2);
    const double right = (s1 - s2) * (e1 - e0);
    if (std::isfinite(e2) && left != right) {
      const double found =
          s1 - 0.5 * ((s1 - s0) * left - (s1 - s2) * right) / (left - right);
      if (found > s0 && found < s2 && value_at(found) < e1) {
        best = found;
      }
    }
    return take(best);
  }
  bool take(double s) {
    const VectorX h = trial(s);
    const double e = value(h);
    if (!(e < now_ - kEnergyRounding * std::abs(now_))) {
      return false;
    }
    h_ = h;
    now_ = e;
    scale_ = s;
    return true;
  }

  const energy::FilmEnergy& energy_;
  const films::FilmTargets& targets_;
  const Points& directions_;
  Points base_;
  const DescentOptions& options_;
  std::vector<int> held_;
  std::vector<double> volume_;  // of the held ones
  VectorX h_;
  VectorX metric_;
  VectorX force_;
  VectorX way_;
  VectorX pressure_;
  double product_ = 0.0;
  double now_ = 0.0;
  double residual_ = 0.0;
  double scale_ = 0.0;
  mutable long evaluations_ = 0;
};

}  // namespace

namespace {

enum class DescentEnd { Moved, Converged, Steps, Evaluations, Stuck };

/// One round: the force, the stop criteria, a step. Where no step falls, once
/// more from the plain force, as rounding may have spoilt conjugacy.
DescentEnd descend_once(Descent& descent, const DescentOptions& options,
                        int steps) {
  // Force -M^-1 r, r = E_h - sum p V_h with the pressures that keep the
  // volumes to first order; the max norm of r is the residual.
  descent.find_force();
  if (descent.residual() <= options.residual_bound) {
    return DescentEnd::Converged;
  }
  if (steps >= options.max_steps) {
    return DescentEnd::Steps;
  }
  if (options.max_evaluations > 0 &&
      descent.evaluations() >= options.max_evaluations) {
    return DescentEnd::Evaluations;
  }
  if (descent.step()) {
    return DescentEnd::Moved;
  }
  descent.restart();
  descent.find_force();
  return descent.step() ? DescentEnd::Moved : DescentEnd::Stuck;
}

const char* message_of(DescentEnd end) {
  switch (end) {
    case DescentEnd::Converged:
      return "the residual is below its bound";
    case DescentEnd::Evaluations:
      return "the evaluations allowed are used up";
    case DescentEnd::Stuck:
      return "no step lowers the energy beyond rounding";
    default:
      return "the steps allowed are used up";
  }
}

}  // namespace

DescentReport descend(const energy::FilmEnergy& energy,
                      const films::FilmTargets& targets,
                      const Points& directions, Points& points,
                      const DescentOptions& options) {
  const Heeding heeding(options.monitor);
  Descent descent(energy, targets, directions, points, options);
  DescentReport report;
  report.energies.push_back(descent.now());
  DescentEnd end = DescentEnd::Moved;
  try {
    while (end == DescentEnd::Moved) {
      if (options.monitor != nullptr) {
        throw_if_stopped(*options.monitor, "film");
      }
      end = descend_once(descent, options, report.steps);
      if (end == DescentEnd::Moved) {
        ++report.steps;
        report.energies.push_back(descent.now());
      }
    }
  } catch (const Interrupted&) {
    points = descent.points();
    throw;
  }
  report.message = message_of(end);
  report.converged = end == DescentEnd::Converged;
  report.evaluations = descent.evaluations();
  report.residual = descent.residual();
  report.scale = descent.scale();
  report.pressure = descent.pressure();
  points = descent.points();
  return report;
}

}  // namespace meniscus::settle
