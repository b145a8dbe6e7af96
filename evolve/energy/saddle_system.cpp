#include "evolve/energy/saddle_system.h"

namespace meniscus::energy {

namespace {

constexpr int kMostRefinements = 4;
constexpr double kAccuracy = 1e-13;  // of the right sides, relative

}  // namespace

SaddleSystem::SaddleSystem(const FilmEnergy& energy,
                           const films::FilmTargets& targets,
                           const Points& points, const FilmPaths& paths,
                           const VectorX& pressure)
    : metric_(energy.lumped_area(points)),
      hessian_(energy.pattern()),
      system_(energy.pattern(), energy.order()) {
  for (int b = 0; b < energy.functionals(); ++b) {
    slopes_.push_back(energy.functional_gradient(points, b));
    if (targets.bodies[b].volume) {
      held_.push_back(b);
    }
  }
  const auto count = static_cast<Eigen::Index>(held_.size());
  const Eigen::MatrixXd rigid =
      energy.rigid_motions(points, paths.first, metric_);
  constraints_.resize(energy.unknowns(), count + rigid.cols());
  for (Eigen::Index k = 0; k < count; ++k) {
    constraints_.col(k) = energy.along(slopes_[held_[k]], paths.first);
  }
  constraints_.rightCols(rigid.cols()) = rigid;
  energy.hessian(points, paths.first, targets, pressure, hessian_,
                 paths.second.empty() ? nullptr : &paths.second);
  factored_ = system_.factorize(hessian_, metric_, 0.0, constraints_);
}

ConstrainedHessian::Step SaddleSystem::solve(const VectorX& residual,
                                             const VectorX& missing) const {
  const auto hessian = hessian_.selfadjointView<Eigen::Lower>();
  const double goal = kAccuracy * (residual.norm() + missing.norm());
  ConstrainedHessian::Step step = system_.solve(residual, missing);
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostRefinements; ++round) {
    const VectorX force = residual + hessian * step.dh - constraints_ * step.dp;
    const VectorX gap = missing - constraints_.transpose() * step.dh;
    const double left = force.norm() + gap.norm();
    if (!(left > goal && left < 0.5 * last)) {
      break;
    }
    last = left;
    const ConstrainedHessian::Step more = system_.solve(force, gap);
    step.dh += more.dh;
    step.dp += more.dp;
  }
  return step;
}

}  // namespace meniscus::energy
