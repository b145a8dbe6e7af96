#include "evolve/curvature_flow.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "evolve/laplacian.h"

namespace meniscus {

namespace {

constexpr double kVolumeStep = 0.15;     // most relative change a step
constexpr double kVolumeReached = 1e-6;  // relative
constexpr int kPressureIterations = 12;

class Flow {
 public:
  Flow(FilmComplex& complex, const FlowOptions& options)
      : complex_(complex), energy_(complex), targets_(targets_of(complex)) {
    const std::size_t count = complex.mesh.points.size();
    unknown_of_.assign(count, -1);
    for (int i = 0; i < energy_.unknowns(); ++i) {
      unknown_of_[energy_.vertices()[i]] = i;
    }
    for (const int label : complex.mesh.facet_label) {
      facet_weight_.push_back(targets_.tension[label]);
    }
    const double edge = energy_.mean_edge(complex.mesh.points);
    const double diagonal = bounding_diagonal(complex.mesh.points);
    tau_ = options.smoothing * options.smoothing * edge * edge;
    most_tau_ = std::max(tau_, diagonal * diagonal);
    for (int b = 0; b < energy_.bodies(); ++b) {
      if (targets_.bodies[b].volume) {
        held_.push_back(b);
      }
    }
  }

  bool has_unknowns() const { return energy_.unknowns() > 0; }

  bool at_volume() const {
    const VectorX v = energy_.volumes(complex_.mesh.points);
    return std::all_of(held_.begin(), held_.end(), [&](int b) {
      const double target = *targets_.bodies[b].volume;
      return std::abs(v[b] - target) <= kVolumeReached * std::abs(target);
    });
  }

  double energy() const {
    const Points& x = complex_.mesh.points;
    double sum = energy_.value(x, targets_.tension);
    const VectorX v = energy_.volumes(x);
    for (int b = 0; b < energy_.bodies(); ++b) {
      sum -= targets_.bodies[b].pressure.value_or(0.0) * v[b];
    }
    return sum;
  }

  /// False when even short steps fail.
  bool step() {
    const bool hold = at_volume();
    const double before = energy();
    const Points old = complex_.mesh.points;
    for (int attempt = 0; attempt < 6; ++attempt) {
      if (try_step()) {
        const double after = energy();
        if (std::isfinite(after) && (!hold || after <= before)) {
          tau_ = std::min(most_tau_, 2.0 * tau_);
          return true;
        }
      }
      complex_.mesh.points = old;
      tau_ *= 0.25;
    }
    return false;
  }

 private:
  bool try_step() {
    Points& x = complex_.mesh.points;
    const int n = energy_.unknowns();
    const auto held = static_cast<int>(held_.size());
    LaplaceSystem laplace = cotan_laplacian(
        complex_.mesh, facet_weight_, unknown_of_, n, CotanWeights::Exact);
    const VectorX mass = energy_.lumped_area(x);
    for (int i = 0; i < n; ++i) {
      laplace.inner.coeffRef(i, i) += mass[i] / tau_;
    }
    if (!factor_) {
      factor_.emplace(laplace.inner, FactorKind::Cholesky, energy_.order());
    }
    if (!factor_->factorize(laplace.inner)) {
      return false;
    }
    Eigen::MatrixXd right(n, 3 * (1 + held));
    right.leftCols<3>() = -energy_.gradient(x, targets_.tension);
    for (int b = 0; b < energy_.bodies(); ++b) {
      if (const double p = targets_.bodies[b].pressure.value_or(0.0);
          p != 0.0) {
        right.leftCols<3>() += p * energy_.volume_gradient(x, b);
      }
    }
    for (int k = 0; k < held; ++k) {
      right.middleCols<3>(3 + 3 * k) = energy_.volume_gradient(x, held_[k]);
    }
    return move_at_volume(factor_->solve(right));
  }

  Points moved(const Eigen::MatrixXd& dx, const VectorX& pressure) const {
    Points x = complex_.mesh.points;
    for (int i = 0; i < energy_.unknowns(); ++i) {
      Vec3 sum = dx.row(i).head<3>();
      for (Eigen::Index k = 0; k < pressure.size(); ++k) {
        sum += pressure[k] * dx.row(i).segment<3>(3 + 3 * k).transpose();
      }
      x[energy_.vertices()[i]] += sum;
    }
    return x;
  }

  /// Finds the pressures at which the moved film has this step's volumes.
  bool move_at_volume(const Eigen::MatrixXd& dx) {
    const auto held = static_cast<Eigen::Index>(held_.size());
    VectorX goal(held);
    const VectorX now = energy_.volumes(complex_.mesh.points);
    for (Eigen::Index k = 0; k < held; ++k) {
      const double target = *targets_.bodies[held_[k]].volume;
      const double most = kVolumeStep * std::abs(target);
      goal[k] = now[held_[k]] + std::clamp(target - now[held_[k]], -most, most);
    }
    VectorX pressure = VectorX::Zero(held);
    Points x = moved(dx, pressure);
    for (int i = 0; i < kPressureIterations && held > 0; ++i) {
      const VectorX volumes = energy_.volumes(x);
      VectorX gap(held);
      for (Eigen::Index k = 0; k < held; ++k) {
        gap[k] = goal[k] - volumes[held_[k]];
      }
      if (gap.cwiseAbs().maxCoeff() <=
          1e-3 * kVolumeReached * goal.cwiseAbs().maxCoeff()) {
        break;
      }
      Eigen::MatrixXd slope(held, held);
      for (Eigen::Index k = 0; k < held; ++k) {
        const Eigen::MatrixX3d b = energy_.volume_gradient(x, held_[k]);
        for (Eigen::Index j = 0; j < held; ++j) {
          slope(k, j) = b.cwiseProduct(dx.middleCols<3>(3 + 3 * j)).sum();
        }
      }
      pressure += slope.completeOrthogonalDecomposition().solve(gap);
      x = moved(dx, pressure);
    }
    if (!flat(x).allFinite()) {
      return false;
    }
    complex_.mesh.points = std::move(x);
    return true;
  }

  FilmComplex& complex_;
  FilmEnergy energy_;
  FilmTargets targets_;
  std::vector<int> unknown_of_;
  std::vector<double> facet_weight_;
  std::vector<int> held_;
  std::optional<SymmetricFactor> factor_;
  double tau_ = 0.0;
  double most_tau_ = 0.0;
};

}  // namespace

FlowReport flow_to_rest(FilmComplex& complex, const FlowOptions& options) {
  Flow flow(complex, options);
  FlowReport report;
  if (!flow.has_unknowns()) {
    report.settled = true;
    return report;
  }
  double energy = flow.energy();
  for (; report.steps < options.max_steps; ++report.steps) {
    if (options.monitor != nullptr) {
      throw_if_stopped(*options.monitor, "film");
    }
    const bool hold = flow.at_volume();
    if (!flow.step()) {
      break;
    }
    const double next = flow.energy();
    if (hold && std::abs(energy - next) <= options.energy_change * energy) {
      report.settled = true;
      break;
    }
    energy = next;
  }
  return report;
}

}  // namespace meniscus
